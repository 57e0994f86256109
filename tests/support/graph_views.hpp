// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/view.hpp>

#include <algorithm>
#include <iterator>
#include <vector>

namespace meshorder::test {

/// The arrays of a graph as a caller has them: of any integer types, counted from 0 or 1.
template <class OffsetType, class IndexType>
struct CallersGraph {
  std::vector<OffsetType> offsets;
  std::vector<IndexType> neighbours;
  int base = 0;

  CallersGraph(const CsrGraph& graph, int first) : base(first) {
    const auto shifted = [first](auto number) { return number + first; };
    std::transform(graph.offsets.begin(), graph.offsets.end(), std::back_inserter(offsets), shifted);
    std::transform(graph.neighbours.begin(), graph.neighbours.end(), std::back_inserter(neighbours), shifted);
  }

  [[nodiscard]] GraphView view() const { return {offsets, neighbours, {}, base}; }
};

/// A view of a graph; the caller keeps the graph alive.
inline GraphView view_of(const CsrGraph& graph) { return {graph.offsets, graph.neighbours}; }

}  // namespace meshorder::test
