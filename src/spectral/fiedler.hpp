// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/fiedler.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

struct FiedlerOptions {
  double tolerance = 0.1;  ///< residual ‖L x − λ x‖ / ‖x‖ relative to λ₂; 0.1 suffices for orders
  int max_iterations = 500;  ///< limit on the iterations of LOBPCG on the whole graph
  std::uint64_t seed = 0;    ///< for random start vectors
  RealView start = {};       ///< an estimate of the Fiedler vector: n numbers, or none
};

/// Returns an order's options for the eigensolver. Throws InvalidArgument unless the tolerance is positive
/// and finite and max_iterations ≥ 1.
FiedlerOptions solver_options(const OrderOptions& options);

struct FiedlerVectors {
  /// The entry of each vertex in the Fiedler vector of its component. The Fiedler vector of two or more
  /// vertices has norm 1 and sums to 0; the entry of a single vertex is 0. Among the entries with at least
  /// half the largest magnitude, that of the vertex with the smallest number is negative.
  std::vector<double> values;
  std::vector<std::vector<Index>> component_vertices;  ///< largest first, see connected_components
  std::vector<FiedlerComponent> components;            ///< reports, in the order of `component_vertices`
  bool complete = true;                                ///< false: the call's time limit ended an iteration
};

/// Computes the Fiedler vector of every connected component of a clean graph, as the public `fiedler_vector`
/// describes it.
///
/// Components of up to 60 vertices go to a dense eigensolver. Larger components are numbered for speed (see
/// ComponentNumbering) and coarsened into a `Hierarchy`. The first vectors are exact on a coarsest graph of
/// up to 60 vertices, else random. `lobpcg`, preconditioned with the hierarchy's cycle, improves them on one
/// graph after the other, from coarse to fine. If a start vector is given, the iteration on the whole graph
/// begins with it; the vector of the coarser graphs becomes its companion.
///
/// @param weights  one for each neighbour, > 0 and finite, the same in both rows of an edge; or none
/// @throws InvalidArgument for another number of weights or of start entries, for a weight that is not
///         positive and finite, for weights whose ratio is above 1e100, and a start entry that is not finite
FiedlerVectors fiedler_vectors(GraphRef graph, std::span<const double> weights,
                               const FiedlerOptions& options = {});

/// The same with weights of 1.
inline FiedlerVectors fiedler_vectors(GraphRef graph, const FiedlerOptions& options = {}) {
  return fiedler_vectors(graph, {}, options);
}

}  // namespace meshorder
