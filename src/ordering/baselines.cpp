// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The reference orders: the order of the file, and a random order.
#include "base/random.hpp"
#include "base/run_scope.hpp"
#include "ordering/all_methods.hpp"

#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Returns a random order by the shuffle of Fisher and Yates.
Permutation shuffled(Index n, std::uint64_t seed) {
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  Random random(seed);
  for (Index i = n - 1; i > 0; --i) {
    poll_in_loop(i);
    std::swap(order[i], order[random.below(static_cast<std::uint64_t>(i) + 1)]);
  }
  return Permutation::from_new_to_old(std::move(order));
}

}  // namespace

Order original_vertices(const VertexInput& input, const OrderOptions&) {
  return {Permutation::identity(input.graph.size()), {}};
}

Order original_elements(const ElementInput& input, const OrderOptions&) {
  return {Permutation::identity(input.elements.size()), {}};
}

Order scrambled_vertices(const VertexInput& input, const OrderOptions& options) {
  return {shuffled(input.graph.size(), options.seed), {}};
}

Order scrambled_elements(const ElementInput& input, const OrderOptions& options) {
  return {shuffled(input.elements.size(), options.seed), {}};
}

}  // namespace meshorder
