// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"

#include <array>

namespace meshorder {

/// Changes x in row v so that this row of L x = b holds. O(row).
template <int M, class RightSide>
void relax_row(const Laplacian& laplacian, Index v, RightSide b, VectorBlock<M>& x) {
  const auto sum = laplacian.neighbour_sum<M>(v, x);
  const double inverse = 1 / laplacian.diagonal[v];
  for (int m = 0; m < M; ++m) x[v][m] = (b(v, m) + sum[m]) * inverse;
}

/// Returns b − L x in row v. O(row).
template <int M>
[[nodiscard]] std::array<double, M> residual_of_row(const Laplacian& laplacian, Index v,
                                                    const VectorBlock<M>& b, const VectorBlock<M>& x) {
  std::array<double, M> residual = laplacian.neighbour_sum<M>(v, x);
  for (int m = 0; m < M; ++m) residual[m] += b[v][m] - laplacian.diagonal[v] * x[v][m];
  return residual;
}

}  // namespace meshorder
