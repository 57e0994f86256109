// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "ordering/method.hpp"
#include "support/sample_meshes.hpp"

#include <cstdint>
#include <string_view>

namespace meshorder::test {

/// The graph with its vertices in a random order.
inline CsrGraph scrambled(const CsrGraph& graph, std::uint64_t seed) {
  return renumbered(graph, shuffled(graph.size(), seed).old_to_new());
}

/// The order that a method gives a graph without points.
inline Permutation order_of(const CsrGraph& graph, std::string_view method, std::uint64_t seed = 0) {
  OrderOptions options;
  options.seed = seed;
  return order_graph(method, {graph, {}}, options).permutation;
}

}  // namespace meshorder::test
