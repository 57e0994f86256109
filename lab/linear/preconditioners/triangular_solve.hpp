// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

namespace meshorder {

/// L D Lᵀ in 3×3 blocks. L is unit lower triangular, with its rows in an order of its own: row i is that of
/// the vertex `vertices[i]`. To the left of its diagonal, row i has the blocks `offsets[i] … offsets[i + 1] −
/// 1`; `columns` lists the vertices of their columns.
struct BlockFactor {
  const Index* vertices;
  const Offset* offsets;
  const Index* columns;
  const float* values;     ///< 9 for each block, row by row; one more number must follow
  const double* inverses;  ///< of D's blocks, 6 for each vertex: 00 01 02 11 12 22
};

/// Solves rows begin … end − 1 of L z = r for z at their vertices. O(blocks).
void solve_lower(const BlockFactor& factor, const double* r, double* z, Index begin, Index end);

/// Solves rows end − 1 … begin of Lᵀ z = y. On entry z is y without the contributions of later rows.
/// O(blocks).
void solve_upper(const BlockFactor& factor, double* z, Index begin, Index end);

/// Computes z = D⁻¹ z at the vertices of the rows begin … end − 1.
void solve_diagonal(const BlockFactor& factor, double* z, Index begin, Index end);

}  // namespace meshorder
