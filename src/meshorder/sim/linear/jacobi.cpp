// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/base/parallel.hpp>
#include <meshorder/sim/linear/jacobi.hpp>

#include <array>
#include <cmath>
#include <string>

namespace meshorder {
namespace {

// as many as threads are worth
constexpr Index kRows = 4096;

double inverse_or_one(double entry) {
  const double inverse = 1.0 / std::abs(entry);
  return std::isfinite(entry) && std::isfinite(inverse) ? inverse : 1.0;
}

/// The block of a vertex on the diagonal.
const double* diagonal_block(const BlockCsr& matrix, Index v) {
  const Offset block = matrix.find(v, v);
  if (block < 0) {
    throw InvalidArgument("preconditioner: the matrix has no diagonal block for the vertex " +
                          std::to_string(v));
  }
  return matrix.values.data() + 9 * block;
}

/// The upper triangle of the inverse of a symmetric block; of its diagonal where it is not positive definite.
std::array<double, 6> inverse_of(const double* a) {
  // the block divided by the square roots of its diagonal, so that small numbers are small for its size
  const std::array<double, 3> scale{std::sqrt(inverse_or_one(a[0])), std::sqrt(inverse_or_one(a[4])),
                                    std::sqrt(inverse_or_one(a[8]))};
  const double b01 = a[1] * scale[0] * scale[1];
  const double b02 = a[2] * scale[0] * scale[2];
  const double b12 = a[5] * scale[1] * scale[2];
  const double c00 = 1.0 - b12 * b12;
  const double c11 = 1.0 - b02 * b02;
  const double c22 = 1.0 - b01 * b01;
  const double determinant = c00 - b01 * (b01 - b02 * b12) + b02 * (b01 * b12 - b02);
  constexpr double kSingular = 1e-12;
  const bool definite = a[0] > 0.0 && a[4] > 0.0 && a[8] > 0.0 && c22 > kSingular && determinant > kSingular;
  if (!definite) return {scale[0] * scale[0], 0.0, 0.0, scale[1] * scale[1], 0.0, scale[2] * scale[2]};
  return {scale[0] * scale[0] * c00 / determinant,
          scale[0] * scale[1] * (b02 * b12 - b01) / determinant,
          scale[0] * scale[2] * (b01 * b12 - b02) / determinant,
          scale[1] * scale[1] * c11 / determinant,
          scale[1] * scale[2] * (b01 * b02 - b12) / determinant,
          scale[2] * scale[2] * c22 / determinant};
}

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
      const double* const block = diagonal_block(matrix, v);
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
      const std::array<double, 6> inverse = inverse_of(diagonal_block(matrix, v));
      std::copy(inverse.begin(), inverse.end(), inverses_.begin() + Offset{6} * v);
    }
  });
}

void BlockJacobi::apply_rows(const double* r, double* z, Index begin, Index end) const {
  for (Index v = begin; v < end; ++v) {
    const double* const m = inverses_.data() + Offset{6} * v;
    const double* const from = r + Offset{3} * v;
    double* const to = z + Offset{3} * v;
    const double r0 = from[0], r1 = from[1], r2 = from[2];
    to[0] = m[0] * r0 + m[1] * r1 + m[2] * r2;
    to[1] = m[1] * r0 + m[3] * r1 + m[4] * r2;
    to[2] = m[2] * r0 + m[4] * r1 + m[5] * r2;
  }
}

std::size_t BlockJacobi::bytes() const { return inverses_.capacity() * sizeof(double); }

}  // namespace meshorder
