// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace meshorder {

/// Coordinates x, y, z; z is 0 in the plane.
using Point = std::array<double, 3>;

}  // namespace meshorder
