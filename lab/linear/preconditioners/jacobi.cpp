// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/preconditioners/jacobi.hpp"

#include "base/parallel.hpp"
#include "lab/linear/preconditioners/symmetric_block.hpp"

#include <algorithm>

namespace meshorder {
namespace {

// rows of a chunk, enough for a task
constexpr Index kRows = 4096;

}  // namespace

void LocalPreconditioner::multiply(std::span<const double> r, std::span<double> z) const {
  for_each_chunk(size(), kRows,
                 [&](Index, Index begin, Index end) { apply_rows(r.data(), z.data(), begin, end); });
}

void Jacobi::take(const BlockCsr& matrix) {
  inverses_.resize(3 * static_cast<std::size_t>(size()));
  for_each_chunk(size(), kRows, [&](Index, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      const double* const block = matrix.values.data() + 9 * diagonal_block(matrix, v);
      for (int c = 0; c < 3; ++c) inverses_[Offset{3} * v + c] = inverse_or_one(block[4 * c]);
    }
  });
}

void Jacobi::apply_rows(const double* r, double* z, Index begin, Index end) const {
  for (Offset i = Offset{3} * begin; i < Offset{3} * end; ++i) z[i] = inverses_[i] * r[i];
}

std::size_t Jacobi::bytes() const { return inverses_.capacity() * sizeof(double); }

void BlockJacobi::take(const BlockCsr& matrix) {
  inverses_.resize(6 * static_cast<std::size_t>(size()));
  for_each_chunk(size(), kRows, [&](Index, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      const double* const block = matrix.values.data() + 9 * diagonal_block(matrix, v);
      const SymmetricBlock inverse = definite_inverse(upper_triangle(block));
      std::copy(inverse.begin(), inverse.end(), inverses_.begin() + Offset{6} * v);
    }
  });
}

void BlockJacobi::apply_rows(const double* r, double* z, Index begin, Index end) const {
  for (Index v = begin; v < end; ++v) {
    meshorder::multiply(inverses_.data() + Offset{6} * v, r + Offset{3} * v, z + Offset{3} * v);
  }
}

std::size_t BlockJacobi::bytes() const { return inverses_.capacity() * sizeof(double); }

}  // namespace meshorder
