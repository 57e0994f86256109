// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder {

/// Returns 46316 as "46,316".
std::string with_commas(long long number);

/// Returns 0.0123 s as "12.3 ms", 75 s as "1 min 15 s".
std::string duration(double seconds);

}  // namespace meshorder
