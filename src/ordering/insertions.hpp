// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/arrangement_graph.hpp"

#include <vector>

namespace meshorder {

/// Improves an order by local search: takes out one vertex after the other and puts it back where the total
/// span is least, `passes` times over or until none moves. Yields the total span that is left.
///
/// The change is exact: when a vertex slides past the next on the line, only the spans of edges at these two
/// change, by a sum that is known, so that each step of a slide costs O(1). A slide ends where the span has
/// risen so far above its least that a better place is rare, or after some steps for each edge.
///
/// Works on chunks of the order, on all threads; vertices stay in their chunk, and those of the next pass
/// overlap two of this. The result does not depend on the number of threads. O(n + edges) a pass.
Offset improve_by_insertions(const ArrangementGraph& graph, std::vector<Index>& order, int passes);

}  // namespace meshorder
