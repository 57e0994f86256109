// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "ordering/arrangement_graph.hpp"

namespace meshorder::test {

/// The graph with all weights and volumes 1.
inline ArrangementGraph arrangement_graph(const CsrGraph& graph) {
  return {graph.offsets, graph.neighbours, {}, std::vector<Index>(graph.size(), 1)};
}

}  // namespace meshorder::test
