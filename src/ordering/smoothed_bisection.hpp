// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <vector>

namespace meshorder {

/// A linear order of a small graph, by bisection down to a few vertices: the vertices in their new order.
///
/// Each piece is cut at the median of a smooth function, the difference of the distances from two far ends
/// averaged over neighbours a few times: what a few steps of the power method make of a good start, and close
/// enough to the Fiedler vector where graphs are small. A piece that is not connected is ordered component by
/// component.
///
/// `pull` has an entry for each vertex: how many neighbours it has in what comes before this graph, less
/// those in what comes after. Of the two directions of each cut the one is taken that brings vertices nearer
/// to their neighbours elsewhere. O((n + edges) · log n) time, O(n + edges) memory; one thread.
std::vector<Index> smoothed_bisection(CsrGraph graph, std::vector<float> pull);

}  // namespace meshorder
