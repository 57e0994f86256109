// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/permutation.hpp>

namespace meshorder {

/// Renumbers each chunk of 2,048 vertices of an order breadth first. The search starts from the vertices with
/// neighbours in earlier chunks, those with the earliest neighbour first.
///
/// A sweep over rows or edges then touches new vertices nearly in the order of their numbers. If vectors
/// exceed the last cache, it reads memory forward, which processors prefetch, as after breadth-first
/// numbering of the whole graph; but each chunk remains the compact region that the order gave it. Vertices
/// move within their chunk only.
///
/// O(n + edges · log degree) on all threads; the result does not depend on their number.
Permutation in_fronts(GraphRef graph, const Permutation& order);

}  // namespace meshorder
