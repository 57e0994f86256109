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
  int iterations = 0;     ///< of LOBPCG on the finest graph; 0 where a dense eigensolver gave the answer
  bool converged = true;  ///< residual ≤ tolerance · λ₂

  bool operator==(const FiedlerComponent&) const = default;
};

/// The Fiedler vectors of all connected components of a graph.
struct Fiedler {
  /// n entries. In each component ‖x‖₂ = 1 and Σ x = 0; an isolated vertex has 0. Sign: of the vertices with
  /// at least half of the largest magnitude, the one with the smallest number has a negative entry.
  std::vector<double> values;
  std::vector<FiedlerComponent> components;  ///< largest first, ties by their smallest vertex
  std::vector<Index> component_of;           ///< n entries: position in `components`
  bool complete = true;                      ///< false: `Run::time_limit` ended the iteration
  std::vector<std::string> notes;            ///< what was cleaned: "12 loops dropped"
};

/// Computes the Fiedler vector of every connected component.
///
/// The Fiedler vector is the eigenvector of the second-smallest eigenvalue of the combinatorial Laplacian L =
/// D − A (Fiedler 1973, Algebraic connectivity of graphs). Components of up to 60 vertices go to a dense
/// eigensolver, larger ones are coarsened by aggregation and solved by LOBPCG (Knyazev 2001, Toward the
/// optimal preconditioned eigensolver) from level to finer level.
///
/// @param graph    n vertices; weights > 0 or none, the largest at most 1e100 times the smallest
/// @param options  tolerance, max_iterations, seed, start, check, symmetry and run; the rest is not used. The
///                 default tolerance of 0.1 suffices for an order; take 1e-8 for a vector to be used as such
/// @return vector and report for each component. A component that does not converge keeps its best vector,
///         with `converged` false: a status, not an error
/// @throws InvalidArgument if `check` refuses the graph, or the size of `start` is neither 0 nor n, or an
///         entry of it is not finite
/// @throws TooLarge for more than 2,147,483,647 vertices
/// @throws Stopped if the progress callback returned false
/// @note O((n + edges) · iterations), about six iterations on meshes; memory about 3.5 times the graph's. The
///       result does not depend on the number of threads, in any bit. Reentrant.
MESHORDER_API Fiedler fiedler_vector(const GraphView& graph, const OrderOptions& options = {});

}  // namespace v0_3
}  // namespace meshorder
