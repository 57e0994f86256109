// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/options.hpp>
#include <meshorder/view.hpp>

#include <cstddef>

namespace meshorder {

/// Throws InvalidArgument unless there are `count` finite points or none. Does nothing with `Check::none`.
/// Calls `poll`. O(points).
void check_finite(const PointsView& points, std::size_t count, Check check);

/// Returns whether neighbours are nearer to each other than random pairs of points, as in a mesh. False
/// suggests that an array is transposed, or of another mesh. True for graphs of fewer than 256 vertices,
/// without edges or without points, and if all points coincide. Samples 256 edges and 256 pairs, the same in
/// every call. O(log n).
bool points_fit(GraphRef graph, const PointsView& points);

}  // namespace meshorder
