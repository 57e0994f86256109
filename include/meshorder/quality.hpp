// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/options.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/view.hpp>

#include <cstdint>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// Measures of how near the two ends of each edge are in an order. The span of edge ij is |rank i − rank j|.
/// All measures are 0 if there are no edges.
struct Quality {
  Offset edges = 0;      ///< without loops; repeats count once
  double mean_span = 0;  ///< ≥ 1; about n/3 for a random order
  /// Mean of log₂ span; weighs short spans more than mean_span, which long spans dominate.
  double mean_log2_span = 0;
  Index bandwidth = 0;  ///< the largest span: the half bandwidth of the matrix with this pattern
  Offset profile = 0;  ///< Σ over rows: diagonal − column of the first entry, if that is before the diagonal
  std::vector<Offset> histogram_log2 = {};  ///< entry k: the number of edges with span in [2ᵏ, 2ᵏ⁺¹)
  /// A product with the matrix reads the vector by cache lines of 8 entries. This is the share, 0 … 1, of the
  /// lines whose first read is a jump: none of the three lines before the line in memory was first read
  /// within the last 32 first reads. If vectors exceed the last cache, the share explains the times of plain
  /// products and springs.
  double jump_share = 0;

  bool operator==(const Quality&) const = default;
};

/// The number of entries of a matrix in each of side × side tiles, rows of tiles from the top.
struct SparsityPattern {
  int side = 0;
  std::vector<std::uint32_t> counts = {};  ///< side · side, row after row

  bool operator==(const SparsityPattern&) const = default;
};

/// Measures the present order of a graph's vertices.
///
/// @param graph     n vertices; weights are not used
/// @param run       threads, progress
/// @param symmetry  mirror: an asymmetric pattern counts as that of A + Aᵀ
/// @throws InvalidArgument if `check` refuses the graph
/// @note O(n + edges). The result does not depend on the number of threads. Caches (except in `jump_share`),
///       prefetching and the traversal of elements are not modelled; see payoff.hpp.
MESHORDER_API Quality quality(const GraphView& graph, const Run& run = {},
                              Symmetry symmetry = Symmetry::require);

/// Measures another order of a graph's vertices, without moving them.
///
/// @param graph     n vertices
/// @param order     n places
/// @param run       threads, progress
/// @param symmetry  as for the present order
/// @throws InvalidArgument if `check` refuses the graph, and if the sizes differ
MESHORDER_API Quality quality(const GraphView& graph, const Permutation& order, const Run& run = {},
                              Symmetry symmetry = Symmetry::require);

/// Counts the edges by their spans in bins of equal width.
///
/// @param graph  n vertices
/// @param order  n places
/// @param width  width of a bin, ≥ 1
/// @param run    threads, progress
/// @return entry k: the number of edges with span in [k · width, (k + 1) · width), up to the largest span
/// @throws InvalidArgument as `quality`, and if width < 1
/// @note O(n + edges).
MESHORDER_API std::vector<Offset> span_histogram(const GraphView& graph, const Permutation& order,
                                                 Index width, const Run& run = {});

/// Counts the entries of a graph's matrix, diagonal included, in square tiles.
///
/// @param graph     n vertices
/// @param order     n places
/// @param side      tiles along each side, ≥ 1; n if n is less
/// @param run       threads, progress
/// @param symmetry  as `quality`
/// @throws InvalidArgument as `quality`, and if side < 1
/// @note O(n + edges).
MESHORDER_API SparsityPattern sparsity_pattern(const GraphView& graph, const Permutation& order, int side,
                                               const Run& run = {}, Symmetry symmetry = Symmetry::require);

}  // namespace v0_3
}  // namespace meshorder
