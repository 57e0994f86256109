// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT Orders of elements by a number that is
// computed from the ranks of an element's vertices.
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"

#include <algorithm>
#include <span>

namespace meshorder {
namespace {

/// Returns the elements sorted by `key_of(vertices)`, a value in the range of the vertices' new numbers; ties
/// by old number. O(elements · log elements).
template <class KeyOf>
Order elements_by_ranks(const ElementInput& input, const KeyOf& key_of) {
  const auto key_of_element = [&](Index e) { return key_of(input.elements[e]); };
  return {sorted_by(input.elements.size(), key_of_element, input.elements.vertex_count,
                    [](auto key) { return static_cast<Index>(key); }),
          {}};
}

}  // namespace

Order min_elements(const ElementInput& input, const OrderOptions&) {
  const std::span<const Index> rank_of = input.vertices.old_to_new();
  return elements_by_ranks(input, [&](std::span<const Index> vertices) {
    return rank_of[*std::ranges::min_element(vertices, {}, [&](Index v) { return rank_of[v]; })];
  });
}

Order max_elements(const ElementInput& input, const OrderOptions&) {
  const std::span<const Index> rank_of = input.vertices.old_to_new();
  return elements_by_ranks(input, [&](std::span<const Index> vertices) {
    return rank_of[*std::ranges::max_element(vertices, {}, [&](Index v) { return rank_of[v]; })];
  });
}

Order mean_elements(const ElementInput& input, const OrderOptions&) {
  const std::span<const Index> rank_of = input.vertices.old_to_new();
  return elements_by_ranks(input, [&](std::span<const Index> vertices) {
    double sum = 0;
    for (const Index v : vertices) sum += rank_of[v];
    return sum / static_cast<double>(vertices.size());
  });
}

}  // namespace meshorder
