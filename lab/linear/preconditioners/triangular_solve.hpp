// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

namespace meshorder {

/// L D Lᵀ in 3×3 blocks. L is unit lower triangular. Row i of L belongs to the vertex `vertices[i]` and has
/// the blocks `offsets[i] … offsets[i + 1] − 1` left of the diagonal; `columns` lists the vertices of their
/// columns.
struct BlockFactor {
  const Index* vertices;
  const Offset* offsets;
  const Index* columns;
  const float* values;     ///< 9 for each block, row by row; one more number must follow
  const double* inverses;  ///< of D's blocks, 6 for each vertex: 00 01 02 11 12 22
};

/// Solves rows begin … end − 1 of L z = r for z at the rows' vertices. O(blocks).
void solve_lower(const BlockFactor& factor, const double* r, double* z, Index begin, Index end);

/// Solves rows end − 1 … begin of Lᵀ z = y. On entry z must be y minus the contributions of the rows of L
/// from `end` on; the function subtracts those of rows begin … end − 1. O(blocks).
void solve_upper(const BlockFactor& factor, double* z, Index begin, Index end);

/// Computes z = D⁻¹ z at the vertices of the rows begin … end − 1.
void solve_diagonal(const BlockFactor& factor, double* z, Index begin, Index end);

}  // namespace meshorder
