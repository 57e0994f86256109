// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/options.hpp>
#include <meshorder/view.hpp>

#include <cstddef>

namespace meshorder {

/// Throws InvalidArgument unless there are `count` finite points or none. Polls. O(points).
void check_finite(const PointsView& points, std::size_t count, Check check);

}  // namespace meshorder
