// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/all_methods.hpp"
#include "ordering/element_ranks.hpp"

#include <numeric>

namespace meshorder {

Ordering mean_elements(const ElementProblem& problem, const OrderingOptions&) {
  return elements_by_ranks(problem, [](std::span<const Index> ranks) {
    return std::accumulate(ranks.begin(), ranks.end(), 0.0) / static_cast<double>(ranks.size());
  });
}

}  // namespace meshorder
