// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder {

/// Returns Highway's name of the instruction set that the kernels use on this processor: "AVX3", "AVX2",
/// "NEON".
std::string simd_target();

}  // namespace meshorder
