// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/options.hpp>
#include <meshorder/view.hpp>

#include <string>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// The eigensolver's report on one connected component.
struct FiedlerComponent {
  Index size = 0;         ///< vertices
  double lambda2 = 0;     ///< second-smallest eigenvalue of the component's Laplacian; 0 for one vertex
  double residual = 0;    ///< ‖L x − λ x‖ / ‖x‖, absolute
  int iterations = 0;     ///< iterations of LOBPCG on the finest graph; 0 if a dense eigensolver was used
  bool converged = true;  ///< residual ≤ tolerance · λ₂

  bool operator==(const FiedlerComponent&) const = default;
};

/// The Fiedler vectors of all connected components of a graph.
struct Fiedler {
  /// n entries. In each component ‖x‖₂ = 1 and Σ x = 0; an isolated vertex has 0. The first entry with at
  /// least half the component's largest magnitude is negative.
  std::vector<double> values;
  std::vector<FiedlerComponent> components;  ///< largest first, ties by their smallest vertex
  std::vector<Index> component_of;           ///< n entries: the component's index in `components`
  bool complete = true;                      ///< false: `Run::time_limit` ended the iteration
  std::vector<std::string> notes;            ///< what was cleaned, such as "12 loops dropped"
};

/// Computes the Fiedler vector of every connected component.
///
/// The Fiedler vector is the eigenvector of the second-smallest eigenvalue of the combinatorial Laplacian L =
/// D − A (Fiedler 1973, Algebraic connectivity of graphs). A dense eigensolver solves components of up to 60
/// vertices. Larger components are coarsened by aggregation and solved level by level, coarsest first, by
/// LOBPCG (Knyazev 2001, Toward the optimal preconditioned eigensolver).
///
/// @param graph    n vertices; weights > 0 or none, the largest at most 1e100 times the smallest
/// @param options  tolerance, max_iterations, seed, start, check, symmetry and run; others are ignored. The
///                 default tolerance of 0.1 suffices for an order; use 1e-8 if the values themselves matter
/// @return the vectors, and a report for each component. A component that does not converge keeps its best
///         vector, with `converged` false; that is not an error
/// @throws InvalidArgument if `check` refuses the graph, if an option or the ratio of weights is out of
///         range, or if `start` has a size other than 0 and n or an entry that is not finite
/// @throws TooLarge for more than 2,147,483,647 vertices
/// @throws Stopped if the progress callback returned false
/// @note O((n + edges) · iterations), about six iterations on meshes; memory about 3.5 times the graph's. The
///       result is the same, bit for bit, on any number of threads. Reentrant.
MESHORDER_API Fiedler fiedler_vector(const GraphView& graph, const OrderOptions& options = {});

}  // namespace v0_3
}  // namespace meshorder
