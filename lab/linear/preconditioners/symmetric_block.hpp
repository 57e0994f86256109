// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/block_csr.hpp"

#include <array>
#include <optional>

namespace meshorder {

/// A symmetric 3×3 block by its upper triangle: 00 01 02 11 12 22.
using SymmetricBlock = std::array<double, 6>;

/// Returns the upper triangle of a block of nine entries, row by row.
inline SymmetricBlock upper_triangle(const double* block) {
  return {block[0], block[1], block[2], block[4], block[5], block[8]};
}

/// Returns the inverse of a positive definite block; nothing if the block is not positive definite or is
/// singular to rounding.
std::optional<SymmetricBlock> inverse_of_definite(const SymmetricBlock& block);

/// Returns 1 / |entry|, or 1 if that or the entry is not finite.
double inverse_or_one(double entry);

/// Returns the inverse of a block; if the block is not positive definite, inverse_or_one of its diagonal. The
/// result is always finite and positive definite.
SymmetricBlock definite_inverse(const SymmetricBlock& block);

/// Returns the index of a vertex's block on the diagonal. Throws InvalidArgument if the pattern lacks the
/// block.
Offset diagonal_block(const BlockCsr& matrix, Index vertex);

/// Computes q = block · p.
inline void multiply(const double* block, const double* p, double* q) {
  const double p0 = p[0], p1 = p[1], p2 = p[2];
  q[0] = block[0] * p0 + block[1] * p1 + block[2] * p2;
  q[1] = block[1] * p0 + block[3] * p1 + block[4] * p2;
  q[2] = block[2] * p0 + block[4] * p1 + block[5] * p2;
}

}  // namespace meshorder
