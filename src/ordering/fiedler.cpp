// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Barnard, Pothen, Simon: A Spectral Algorithm for Envelope Reduction of Sparse Matrices (1993); the paper,
// sections 3 and 4.1.
#include "ordering/all_methods.hpp"

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

/// Component after component, largest first, each by rising Fiedler value, ties by old number.
Ordering by_fiedler_vector(GraphRef graph, const OrderingOptions& options) {
  FiedlerOptions solver;
  solver.tolerance = options.tolerance;
  solver.seed = options.seed;
  FiedlerResult fiedler = fiedler_vector(graph, solver);
  std::vector<Index> new_to_old;
  new_to_old.reserve(graph.size());
  std::vector<std::pair<double, Index>> sorted;
  for (const std::vector<Index>& component : fiedler.component_vertices) {
    sorted.clear();
    for (const Index v : component) sorted.emplace_back(fiedler.values[v], v);
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [value, v] : sorted) new_to_old.push_back(v);
  }
  return {Permutation::from_new_to_old(std::move(new_to_old)), std::move(fiedler.components)};
}

}  // namespace

Ordering fiedler_vertices(const VertexProblem& problem, const OrderingOptions& options) {
  return by_fiedler_vector(problem.graph, options);
}

Ordering fiedler_elements(const ElementProblem& problem, const OrderingOptions& options) {
  return by_fiedler_vector(dual_graph_by_vertex(problem.elements), options);
}

Ordering fiedler_facet_elements(const ElementProblem& problem, const OrderingOptions& options) {
  return by_fiedler_vector(problem.facet_graph(), options);
}

}  // namespace meshorder
