// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include <meshorder/permutation.hpp>
#include <meshorder/quality.hpp>

#include <array>
#include <span>

namespace meshorder {

/// Computes the public `sparsity_pattern` of a clean graph. O(n + edges).
SparsityPattern pattern_of(GraphRef graph, const Permutation& order, int side);

/// Iterations of conjugate gradients with two preconditioners.
struct Iterations {
  int incomplete_cholesky =
      0;  ///< a factor with as many entries in each column as the matrix has (Lin and Moré 1999)
  int gauss_seidel = 0;  ///< a sweep forward and one backward

  bool operator==(const Iterations&) const = default;
};

/// Returns how many iterations conjugate gradients need with each of two preconditioners, which depend on the
/// order, until the residual is at most 1e-8 of the right side. The matrix is the Laplacian of the graph in
/// that order, with a hundredth of the mean degree added to its diagonal. A vertex's entry of the right side
/// is the same in every order. More than 1,000 iterations count as 1,000. O(entries · iterations), and 40
/// bytes an entry.
Iterations iterations_in(GraphRef graph, const Permutation& order);

/// Returns how many entries below the diagonal the Cholesky factor has, for a matrix with this pattern in the
/// given order: what a sparse direct solver stores, if no entry cancels. Includes the entries of the matrix.
/// O(n + entries of the graph · α(n)), without the factor's pattern (Gilbert, Ng, Peyton 1994, An efficient
/// algorithm to compute row and column counts for sparse Cholesky factorization).
Offset factor_entries(GraphRef graph, const Permutation& order);

/// Sweeps over the rows of a matrix and returns the share of the vector's lines (8 entries each) whose first
/// touch is a jump. The first touch of a line is a jump unless one of the three lines before it is among the
/// last 32 lines that were touched for the first time. Rows are in the given order, the entries of a row in
/// the order of their columns.
///
/// If vectors exceed the last cache, a sweep reads every line from memory once, and processors prefetch
/// consecutive lines. On meshes of that size, this share explains how fast plain products and springs run in
/// different orders; numbers of cache misses do not.
///
/// `sampled_jump_share` estimates the share from evenly spread windows of 4,096 rows: one window in 16, but
/// at most 9 windows.
///
/// @return 0 for breadth-first orders of meshes, about 1 for random orders; 0 for a graph without vertices
/// @note O(n + edges).
double jump_share(GraphRef graph, const Permutation& order);
double sampled_jump_share(GraphRef graph, const Permutation& order);

/// Numbers of consecutive elements for which working sets are counted: powers of two, ascending.
inline constexpr std::array<Index, 3> kElementsAtOnce{64, 512, 4096};

/// Returns for each k in `kElementsAtOnce` the mean number of distinct vertices that k consecutive
/// elements use in that order (Denning 1968: The working set model for program behavior). While these
/// elements are visited, the data of these vertices, and of pairs of them, pass through the caches.
///
/// Counted at up to 15 places, evenly spread. O(vertices + 61,440 elements).
///
/// @param new_to_old  the order of all elements; empty: the order of their numbers
std::array<double, kElementsAtOnce.size()> working_sets(IncidenceRef elements,
                                                        std::span<const Index> new_to_old);

}  // namespace meshorder
