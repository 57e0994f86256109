// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include "graph/csr_graph.hpp"

#include <array>
#include <vector>

namespace meshorder {

/// `M` real vectors of n entries, stored so that the M entries of a vertex are side by side: one pass over a
/// graph serves all vectors.
template <int M>
using VectorBlock = std::vector<std::array<double, M>>;

/// The Laplacian L = D − A of a weighted graph as an operator. Row v has minus the weight of each neighbour,
/// and the sum of these weights on the diagonal. Constant vectors are in the null space.
struct Laplacian {
  std::vector<Offset> offsets{0};  ///< n + 1
  std::vector<Index> neighbours;
  std::vector<double> weights;   ///< one for each neighbour; empty when all are 1
  std::vector<double> diagonal;  ///< n

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] bool is_weighted() const noexcept { return !weights.empty(); }
  [[nodiscard]] double weight(Offset k) const { return is_weighted() ? weights[k] : 1.0; }

  /// Returns Σ weight · x over the neighbours of v: minus the off-diagonal part of row v of L x.
  template <int M>
  [[nodiscard]] std::array<double, M> neighbour_sum(Index v, const VectorBlock<M>& x) const {
    std::array<double, M> sum{};
    const std::array<double, M>* const entries = x.data();
    const Index* const end = neighbours.data() + offsets[v + 1];
    const Index* u = neighbours.data() + offsets[v];
    if (is_weighted()) {
      for (const double* weight = weights.data() + offsets[v]; u < end; ++u, ++weight) {
        for (int m = 0; m < M; ++m) sum[m] += *weight * entries[*u][m];
      }
    } else {
      for (; u < end; ++u) {
        for (int m = 0; m < M; ++m) sum[m] += entries[*u][m];
      }
    }
    return sum;
  }

  /// Computes y = L x from differences along edges, which avoids cancellation where x hardly varies;
  /// eigenvectors hardly vary along heavy edges. O(n + edges), on all threads.
  template <int M>
  void apply(const VectorBlock<M>& x, VectorBlock<M>& y) const {
    constexpr Index kRows = 4096;
    for_each_chunk(size(), kRows, [&](Index, Index begin, Index end) {
      for (Index v = begin; v < end; ++v) {
        std::array<double, M> sum{};
        const std::array<double, M> here = x[v];
        for (Offset k = offsets[v]; k < offsets[v + 1]; ++k) {
          const std::array<double, M>& there = x[neighbours[k]];
          for (int m = 0; m < M; ++m) sum[m] += weight(k) * (here[m] - there[m]);
        }
        y[v] = sum;
      }
    });
  }
};

/// Sets row v of x so that row v of L x = b holds. O(row).
template <int M, class RightSide>
void relax_row(const Laplacian& laplacian, Index v, RightSide b, VectorBlock<M>& x) {
  const auto sum = laplacian.neighbour_sum<M>(v, x);
  const double inverse = 1 / laplacian.diagonal[v];
  for (int m = 0; m < M; ++m) x[v][m] = (b(v, m) + sum[m]) * inverse;
}

/// Returns row v of b − L x. O(row).
template <int M>
[[nodiscard]] std::array<double, M> residual_of_row(const Laplacian& laplacian, Index v,
                                                    const VectorBlock<M>& b, const VectorBlock<M>& x) {
  std::array<double, M> residual = laplacian.neighbour_sum<M>(v, x);
  for (int m = 0; m < M; ++m) residual[m] += b[v][m] - laplacian.diagonal[v] * x[v][m];
  return residual;
}

}  // namespace meshorder
