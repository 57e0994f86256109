// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/preconditioners/jacobi.hpp"

#include "base/parallel.hpp"
#include "lab/linear/preconditioners/symmetric_block.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <string>

namespace meshorder {
namespace {

// rows of a chunk, enough for a task
constexpr Index kRows = 4096;

}  // namespace

void LocalPreconditioner::apply(std::span<const double> r, std::span<double> z) const {
  const auto entries = 3 * static_cast<std::size_t>(vertices_);
  if (r.size() != entries || z.size() != entries) {
    throw InvalidArgument("preconditioner: r and z must hold 3 doubles for each vertex");
  }
  for_each_chunk(vertices_, kRows,
                 [&](Index, Index begin, Index end) { apply_rows(r.data(), z.data(), begin, end); });
}

void LocalPreconditioner::check_size(const BlockCsr& matrix) const {
  if (matrix.size() != vertices_) {
    throw InvalidArgument("preconditioner: made for " + std::to_string(vertices_) +
                          " vertices, the matrix has " + std::to_string(matrix.size()));
  }
}

void Jacobi::update(const BlockCsr& matrix) {
  check_size(matrix);
  inverses_.resize(3 * static_cast<std::size_t>(vertices()));
  for_each_chunk(vertices(), kRows, [&](Index, Index begin, Index end) {
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

void BlockJacobi::update(const BlockCsr& matrix) {
  check_size(matrix);
  inverses_.resize(6 * static_cast<std::size_t>(vertices()));
  for_each_chunk(vertices(), kRows, [&](Index, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      const double* const block = matrix.values.data() + 9 * diagonal_block(matrix, v);
      const SymmetricBlock inverse = definite_inverse(upper_triangle(block));
      std::copy(inverse.begin(), inverse.end(), inverses_.begin() + Offset{6} * v);
    }
  });
}

void BlockJacobi::apply_rows(const double* r, double* z, Index begin, Index end) const {
  for (Index v = begin; v < end; ++v) {
    multiply(inverses_.data() + Offset{6} * v, r + Offset{3} * v, z + Offset{3} * v);
  }
}

std::size_t BlockJacobi::bytes() const { return inverses_.capacity() * sizeof(double); }

}  // namespace meshorder
