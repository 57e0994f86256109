// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/graph/csr_graph.hpp>

#include <array>
#include <vector>

namespace meshorder {

/// `M` real vectors of n entries stored together: entry v of all of them side by side, so that one pass over
/// a graph serves all.
template <int M>
using VectorBlock = std::vector<std::array<double, M>>;

/// The Laplacian L = D − A of a weighted graph as an operator. Row v has −weight at each neighbour and on the
/// diagonal the sum of its weights, so that constants are in the null space.
struct Laplacian {
  std::vector<Offset> offsets{0};  ///< n + 1
  std::vector<Index> neighbours;
  std::vector<double> weights;   ///< one for each neighbour; empty when all are 1
  std::vector<double> diagonal;  ///< n

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] bool is_weighted() const noexcept { return !weights.empty(); }

  /// Σ weight · x over the neighbours of v: minus the off-diagonal part of row v of L x.
  template <int M>
  [[nodiscard]] std::array<double, M> neighbour_sum(Index v, const VectorBlock<M>& x) const {
    std::array<double, M> sum{};
    const Offset end = offsets[v + 1];
    if (is_weighted()) {
      for (Offset k = offsets[v]; k < end; ++k) {
        for (int m = 0; m < M; ++m) sum[m] += weights[k] * x[neighbours[k]][m];
      }
    } else {
      for (Offset k = offsets[v]; k < end; ++k) {
        for (int m = 0; m < M; ++m) sum[m] += x[neighbours[k]][m];
      }
    }
    return sum;
  }

  /// y = L x. O(n + edges).
  template <int M>
  void apply(const VectorBlock<M>& x, VectorBlock<M>& y) const {
    for (Index v = 0; v < size(); ++v) {
      const auto sum = neighbour_sum<M>(v, x);
      for (int m = 0; m < M; ++m) y[v][m] = diagonal[v] * x[v][m] - sum[m];
    }
  }
};

/// The Laplacian of a graph whose edges all have weight 1. O(n + edges).
Laplacian combinatorial_laplacian(const CsrGraph& graph);

}  // namespace meshorder
