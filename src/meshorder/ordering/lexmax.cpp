// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/ordering/all_methods.hpp>

#include <algorithm>
#include <compare>
#include <functional>
#include <numeric>
#include <span>

namespace meshorder {
namespace {

/// The ranks of every element's vertices, falling within each element.
std::vector<Index> falling_ranks(const ElementProblem& problem) {
  const Incidence& elements = problem.elements;
  std::vector<Index> ranks(elements.vertices.size());
  std::transform(elements.vertices.begin(), elements.vertices.end(), ranks.begin(),
                 [&](Index v) { return problem.vertices.old_to_new()[v]; });
  for (Index e = 0; e < elements.size(); ++e) {
    std::sort(ranks.begin() + elements.offsets[e], ranks.begin() + elements.offsets[e + 1], std::greater<>());
  }
  return ranks;
}

}  // namespace

Ordering lexmax_elements(const ElementProblem& problem, const OrderingOptions&) {
  const Incidence& elements = problem.elements;
  const std::vector<Index> ranks = falling_ranks(problem);

  // a bucket for each largest rank, filled in element order
  std::vector<Index> bucket(Offset{elements.vertex_count} + 1, 0);
  for (Index e = 0; e < elements.size(); ++e) ++bucket[ranks[elements.offsets[e]] + 1];
  std::partial_sum(bucket.begin(), bucket.end(), bucket.begin());
  std::vector<Index> next(bucket.begin(), bucket.end() - 1);
  std::vector<Index> new_to_old(elements.size());
  for (Index e = 0; e < elements.size(); ++e) new_to_old[next[ranks[elements.offsets[e]]]++] = e;

  // the few elements of each bucket by the rest of their ranks, ties by number
  const auto before = [&](Index a, Index b) {
    const auto rest = [&](Index e) {
      return std::span(ranks.data() + elements.offsets[e] + 1, ranks.data() + elements.offsets[e + 1]);
    };
    const auto order = std::lexicographical_compare_three_way(rest(a).begin(), rest(a).end(), rest(b).begin(),
                                                              rest(b).end());
    return order < 0 || (order == 0 && a < b);
  };
  for (Index v = 0; v < elements.vertex_count; ++v) {
    std::sort(new_to_old.begin() + bucket[v], new_to_old.begin() + bucket[v + 1], before);
  }
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace meshorder
