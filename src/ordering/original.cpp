// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/all_methods.hpp"

namespace meshorder {

Ordering original_vertices(const VertexProblem& problem, const OrderingOptions&) {
  return {Permutation::identity(problem.graph.size()), {}};
}

Ordering original_elements(const ElementProblem& problem, const OrderingOptions&) {
  return {Permutation::identity(problem.elements.size()), {}};
}

}  // namespace meshorder
