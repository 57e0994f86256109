// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder {

/// Highway's name for the instructions that the kernels take on this processor: "AVX3", "AVX2", "NEON".
std::string simd_target();

}  // namespace meshorder
