// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "lab/linear/preconditioners/preconditioner.hpp"

namespace meshorder {

/// A preconditioner whose z at a vertex depends only on r at that vertex, so that a solver can apply it to a
/// few rows at a time while they are in the cache.
class LocalPreconditioner : public Preconditioner {
 public:
  using Preconditioner::Preconditioner;

  /// Computes z ≈ A⁻¹ r for the vertices begin … end − 1; r and z as in `apply`.
  virtual void apply_rows(const double* r, double* z, Index begin, Index end) const = 0;

 private:
  void multiply(std::span<const double> r, std::span<double> z) const final;
};

/// Divides by the diagonal: z_i = r_i / |a_ii|. A diagonal entry that is 0 or not finite counts as 1, so that
/// the preconditioner stays positive definite and the solver detects the bad matrix.
class Jacobi final : public LocalPreconditioner {
 public:
  using LocalPreconditioner::LocalPreconditioner;
  void apply_rows(const double* r, double* z, Index begin, Index end) const override;
  [[nodiscard]] std::size_t bytes() const override;

 private:
  void take(const BlockCsr& matrix) override;

  AlignedVector<double> inverses_;  ///< 3 for each vertex
};

/// Inverts the 3×3 blocks A_vv of the diagonal: z_v = A_vv⁻¹ r_v. Reads their upper triangles. A block that
/// is not positive definite is replaced by its diagonal, as in `Jacobi`.
class BlockJacobi final : public LocalPreconditioner {
 public:
  using LocalPreconditioner::LocalPreconditioner;
  void apply_rows(const double* r, double* z, Index begin, Index end) const override;
  [[nodiscard]] std::size_t bytes() const override;

 private:
  void take(const BlockCsr& matrix) override;

  AlignedVector<double> inverses_;  ///< 6 for each vertex: 00 01 02 11 12 22
};

}  // namespace meshorder
