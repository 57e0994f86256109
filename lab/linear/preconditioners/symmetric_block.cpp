// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/preconditioners/symmetric_block.hpp"

#include <meshorder/error.hpp>

#include <cmath>
#include <string>

namespace meshorder {

double inverse_or_one(double entry) {
  const double inverse = 1.0 / std::abs(entry);
  return std::isfinite(entry) && std::isfinite(inverse) ? inverse : 1.0;
}

std::optional<SymmetricBlock> inverse_of_definite(const SymmetricBlock& block) {
  if (!(block[0] > 0.0 && block[3] > 0.0 && block[5] > 0.0)) return std::nullopt;
  // scales the diagonal to ones, so that a number below a fixed bound can only be a rounding error
  const std::array<double, 3> scale{1.0 / std::sqrt(block[0]), 1.0 / std::sqrt(block[3]),
                                    1.0 / std::sqrt(block[5])};
  const double b01 = block[1] * scale[0] * scale[1];
  const double b02 = block[2] * scale[0] * scale[2];
  const double b12 = block[4] * scale[1] * scale[2];
  const double c22 = 1.0 - b01 * b01;
  const double determinant = c22 - b02 * b02 - b12 * b12 + 2.0 * b01 * b02 * b12;
  constexpr double kSingular = 1e-12;
  if (!(c22 > kSingular && determinant > kSingular)) return std::nullopt;
  const SymmetricBlock inverse{scale[0] * scale[0] * (1.0 - b12 * b12) / determinant,
                               scale[0] * scale[1] * (b02 * b12 - b01) / determinant,
                               scale[0] * scale[2] * (b01 * b12 - b02) / determinant,
                               scale[1] * scale[1] * (1.0 - b02 * b02) / determinant,
                               scale[1] * scale[2] * (b01 * b02 - b12) / determinant,
                               scale[2] * scale[2] * c22 / determinant};
  for (const double entry : inverse) {
    if (!std::isfinite(entry)) return std::nullopt;
  }
  return inverse;
}

SymmetricBlock definite_inverse(const SymmetricBlock& block) {
  return inverse_of_definite(block).value_or(SymmetricBlock{
      inverse_or_one(block[0]), 0.0, 0.0, inverse_or_one(block[3]), 0.0, inverse_or_one(block[5])});
}

Offset diagonal_block(const BlockCsr& matrix, Index vertex) {
  const Offset block = matrix.find(vertex, vertex);
  if (block < 0) {
    throw InvalidArgument("preconditioner: the matrix has no diagonal block for the vertex " +
                          std::to_string(vertex));
  }
  return block;
}

}  // namespace meshorder
