// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/sparsity_pattern.hpp"

#include <algorithm>

namespace meshorder {

SparsityPattern pattern_of(GraphRef graph, const Permutation& order, int side) {
  SparsityPattern pattern;
  pattern.side = std::min(side, graph.size());
  const auto tile = [&](Index place) { return Offset{place} * pattern.side / graph.size(); };
  pattern.counts.resize(static_cast<std::size_t>(pattern.side) * pattern.side);
  for (Index v = 0; v < graph.size(); ++v) {
    const Index row = order.old_to_new()[v];
    const Offset first = tile(row) * pattern.side;
    ++pattern.counts[first + tile(row)];  // the diagonal entry
    for (const Index neighbour : graph[v]) ++pattern.counts[first + tile(order.old_to_new()[neighbour])];
  }
  return pattern;
}

}  // namespace meshorder
