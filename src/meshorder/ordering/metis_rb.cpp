// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Karypis, Kumar: A Fast and High Quality Multilevel Scheme for Partitioning Irregular Graphs (1998). Parts
// are numbered along the tree of bisections, so that parts of one half of the mesh, or a quarter, stand
// together.
#include <meshorder/ordering/all_methods.hpp>
#include <meshorder/ordering/metis.hpp>
#include <meshorder/ordering/sorted.hpp>

#include <algorithm>

namespace meshorder {
namespace {

constexpr Index kPartSize = 8;  // smaller parts cost METIS more and no longer shorten spans

}  // namespace

Ordering metis_rb_vertices(const VertexProblem& problem, const OrderingOptions& options) {
  idx_t parts = (problem.graph.size() + kPartSize - 1) / kPartSize;
  if (parts <= 1 || problem.graph.neighbours.empty()) {
    return {Permutation::identity(problem.graph.size()), {}};
  }
  MetisGraph graph(problem.graph, options.seed);
  idx_t constraints = 1;
  idx_t cut = 0;
  std::vector<idx_t> part_of(problem.graph.size());
  check_metis(METIS_PartGraphRecursive(&graph.size, &constraints, graph.offsets.data(),
                                       graph.neighbours.data(), nullptr, nullptr, nullptr, &parts, nullptr,
                                       nullptr, graph.options, &cut, part_of.data()),
              "METIS_PartGraphRecursive");
  return {sorted_by(part_of), {}};
}

}  // namespace meshorder
