// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/view.hpp>

namespace meshorder {

/// Returns whether neighbours are nearer to each other than any two points are, as they are in a mesh: false
/// suggests that an array is transposed, or of another mesh. True for graphs of fewer than 256 vertices,
/// without edges or without points, and if all points coincide. Samples 256 edges and as many pairs, the same
/// ones in every call. O(log n).
bool points_fit(GraphRef graph, const PointsView& points);

}  // namespace meshorder
