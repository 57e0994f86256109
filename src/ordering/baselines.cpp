// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The orders that others are measured against: the file's, and a random one.
#include "base/random.hpp"
#include "ordering/all_methods.hpp"

#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Fisher and Yates' shuffle.
Permutation shuffled(Index n, std::uint64_t seed) {
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  Random random(seed);
  for (Index i = n - 1; i > 0; --i) {
    std::swap(order[i], order[random.below(static_cast<std::uint64_t>(i) + 1)]);
  }
  return Permutation::from_new_to_old(std::move(order));
}

}  // namespace

Ordering original_vertices(const VertexProblem& problem, const OrderingOptions&) {
  return {Permutation::identity(problem.graph.size()), {}};
}

Ordering original_elements(const ElementProblem& problem, const OrderingOptions&) {
  return {Permutation::identity(problem.elements.size()), {}};
}

Ordering scrambled_vertices(const VertexProblem& problem, const OrderingOptions& options) {
  return {shuffled(problem.graph.size(), options.seed), {}};
}

Ordering scrambled_elements(const ElementProblem& problem, const OrderingOptions& options) {
  return {shuffled(problem.elements.size(), options.seed), {}};
}

}  // namespace meshorder
