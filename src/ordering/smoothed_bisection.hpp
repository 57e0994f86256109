// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <vector>

namespace meshorder {

/// Orders a small graph by bisection down to a few vertices. Returns the vertices in their new order.
///
/// Each piece is cut at the median of a smooth function: the difference of the distances from two far ends,
/// averaged over neighbours a few times. These are a few steps of the power method from a good start; in
/// small graphs the result is close enough to the Fiedler vector. A piece that is not connected is ordered
/// component by component.
///
/// `pull` has an entry for each vertex: the number of its neighbours before this graph in the whole order
/// minus that of neighbours after it. Each cut takes the direction that brings vertices nearer
/// to their neighbours elsewhere. O((n + edges) · log n) time, O(n + edges) memory; one thread.
std::vector<Index> smoothed_bisection(CsrGraph graph, std::vector<float> pull);

}  // namespace meshorder
