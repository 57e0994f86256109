// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Karypis, Kumar: A Fast and High Quality Multilevel Scheme for Partitioning Irregular Graphs (1998).
#include "ordering/all_methods.hpp"
#include "ordering/metis.hpp"

namespace meshorder {

Ordering metis_nd_vertices(const VertexProblem& problem, const OrderingOptions& options) {
  if (problem.graph.neighbours.empty()) return {Permutation::identity(problem.graph.size()), {}};
  MetisGraph graph(problem.graph, options.seed);
  std::vector<idx_t> new_to_old(problem.graph.size());
  std::vector<idx_t> old_to_new(problem.graph.size());
  check_metis(METIS_NodeND(&graph.size, graph.offsets.data(), graph.neighbours.data(), nullptr, graph.options,
                           new_to_old.data(), old_to_new.data()),
              "METIS_NodeND");
  return {Permutation::from_new_to_old({new_to_old.begin(), new_to_old.end()}), {}};
}

}  // namespace meshorder
