// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/study/results.hpp>

namespace meshorder {

/// This machine, and what this program was made with. Measures the bandwidths, in about a second.
MachineRecord describe_machine();

}  // namespace meshorder
