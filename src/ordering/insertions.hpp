// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/arrangement_graph.hpp"

#include <vector>

namespace meshorder {

/// Improves an order by local search: takes out each vertex in turn and puts it back where the total span is
/// least. Makes `passes` passes, fewer if none moves. Returns the total span of the result.
///
/// Changes are computed exactly: when a vertex slides past the next on the line, only the spans of edges at
/// these two change, by a known sum, so that each step of a slide costs O(1). A slide ends when the span has
/// risen so far above its least that a better place is rare, or after a number of steps for each edge.
///
/// Works on chunks of the order, on all threads. Vertices stay in their chunk; each chunk of the next pass
/// overlaps two of this one. The result does not depend on the number of threads. O(n + edges) a pass.
Offset improve_by_insertions(const ArrangementGraph& graph, std::vector<Index>& order, int passes);

}  // namespace meshorder
