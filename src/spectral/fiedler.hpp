// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

struct FiedlerOptions {
  double tolerance = 0.1;  ///< residual ‖L x − λ x‖ / ‖x‖ relative to λ₂; the order settles at 0.1
  int max_iterations = 500;  ///< of LOBPCG on the whole graph
  std::uint64_t seed = 0;    ///< of the start vector, where one is needed
};

/// How it went on one connected component.
struct FiedlerComponent {
  Index size = 0;
  double lambda2 = 0;   ///< second-smallest eigenvalue of the component's Laplacian; 0 for one vertex
  double residual = 0;  ///< ‖L x − λ x‖ / ‖x‖, absolute
  int iterations = 0;   ///< of LOBPCG on the finest graph; 0 where the answer is direct
  bool converged = true;
};

struct FiedlerResult {
  /// For each vertex its entry in the Fiedler vector of its component, which has norm 1 and sums to 0. The
  /// sign is such that the first vertex, by number, whose entry reaches half the largest magnitude is
  /// negative.
  std::vector<double> values;
  std::vector<std::vector<Index>> component_vertices;  ///< largest first, see connected_components
  std::vector<FiedlerComponent> components;            ///< of the same order
};

/// The Fiedler vector of every connected component: the eigenvector of the second-smallest eigenvalue of its
/// combinatorial Laplacian, which minimises the sum of squared differences over edges (the paper, section 3;
/// Fiedler 1973).
///
/// Components of up to 60 vertices go to a dense eigensolver. Larger ones are numbered for speed (see
/// ComponentNumbering), coarsened into a `Hierarchy`, solved exactly on the coarsest graph, and the vector is
/// improved from graph to finer graph by `lobpcg` preconditioned with the hierarchy's cycle. The same input
/// gives the same bits on every run and on any number of threads. A component that does not converge in time
/// keeps its best vector and says so. Memory: about 3.5 times the graph's on meshes. Time: O(n + edges) times
/// the iterations, about six on meshes.
FiedlerResult fiedler_vector(GraphRef graph, const FiedlerOptions& options = {});

/// The same of a weighted graph: `weights` has an entry for each of the graph's neighbours, the same in both
/// rows of an edge. Throws InvalidArgument for another number of weights and for one that is not positive and
/// finite.
FiedlerResult fiedler_vector(GraphRef graph, std::span<const double> weights,
                             const FiedlerOptions& options = {});

}  // namespace meshorder
