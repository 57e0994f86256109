// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

/// Returns the rate in 10⁹ operations a second at which one thread multiplies and adds doubles (two
/// operations each), in the best vector instructions that the kernels choose: the ceiling of a roofline.
/// Takes the best of several rounds.
double peak_gflops();
