// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/study/motion_file.hpp>
#include <meshorder/study/results.hpp>

namespace meshorder {

/// How far the same vertices are apart in two motions of a body whose box's longest side is that long, frame
/// by frame. Throws InvalidArgument when they have other numbers of vertices or frames. O(vertices · frames).
MotionDifference difference_of(const Motion& motion, const Motion& reference, double longest_side);

}  // namespace meshorder
