// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"
#include "ordering/sorted.hpp"

namespace meshorder {

/// Elements sorted by `key(ranks)`, where `ranks` are the new numbers of an element's vertices; ties by old
/// number. O(elements · log elements).
template <class Key>
Ordering elements_by_ranks(const ElementProblem& problem, Key key) {
  using Value = decltype(key(std::span<const Index>()));
  std::vector<Value> keys;
  keys.reserve(problem.elements.size());
  std::vector<Index> ranks;
  for (Index e = 0; e < problem.elements.size(); ++e) {
    ranks.clear();
    for (const Index v : problem.elements[e]) ranks.push_back(problem.vertices.old_to_new()[v]);
    keys.push_back(key(std::span<const Index>(ranks)));
  }
  return {sorted_by(keys), {}};
}

}  // namespace meshorder
