// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/all_methods.hpp"
#include "ordering/element_ranks.hpp"

#include <algorithm>

namespace meshorder {

Ordering max_elements(const ElementProblem& problem, const OrderingOptions&) {
  return elements_by_ranks(
      problem, [](std::span<const Index> ranks) { return *std::max_element(ranks.begin(), ranks.end()); });
}

}  // namespace meshorder
