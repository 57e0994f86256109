// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Elements sorted by one number that the ranks of their vertices give.
#include "base/run_scope.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"

#include <algorithm>
#include <numeric>

namespace meshorder {
namespace {

/// Elements sorted by `key(ranks)`, where `ranks` are the new numbers of an element's vertices; ties by old
/// number. O(elements · log elements).
template <class Key>
Order elements_by_ranks(const ElementInput& input, Key key) {
  using Value = decltype(key(std::span<const Index>()));
  std::vector<Value> keys;
  keys.reserve(input.elements.size());
  std::vector<Index> ranks;
  for (Index e = 0; e < input.elements.size(); ++e) {
    poll_in_loop(e);
    ranks.clear();
    for (const Index v : input.elements[e]) ranks.push_back(input.vertices.old_to_new()[v]);
    keys.push_back(key(std::span<const Index>(ranks)));
  }
  return {sorted_by(keys), {}};
}

}  // namespace

Order min_elements(const ElementInput& input, const OrderOptions&) {
  return elements_by_ranks(
      input, [](std::span<const Index> ranks) { return *std::min_element(ranks.begin(), ranks.end()); });
}

Order max_elements(const ElementInput& input, const OrderOptions&) {
  return elements_by_ranks(
      input, [](std::span<const Index> ranks) { return *std::max_element(ranks.begin(), ranks.end()); });
}

Order mean_elements(const ElementInput& input, const OrderOptions&) {
  return elements_by_ranks(input, [](std::span<const Index> ranks) {
    return std::accumulate(ranks.begin(), ranks.end(), 0.0) / static_cast<double>(ranks.size());
  });
}

}  // namespace meshorder
