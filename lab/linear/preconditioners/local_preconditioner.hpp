// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/preconditioners/preconditioner.hpp"

namespace meshorder {

/// A preconditioner whose z at a vertex depends on r at that vertex alone, so that a solver may apply it a
/// few rows at a time, while it has them at hand.
class LocalPreconditioner : public Preconditioner {
 public:
  /// Throws InvalidArgument when a size does not fit.
  void apply(std::span<const double> r, std::span<double> z) const final;

  /// z ≈ A⁻¹ r for the vertices begin … end − 1; r and z as in `apply`.
  virtual void apply_rows(const double* r, double* z, Index begin, Index end) const = 0;

 protected:
  explicit LocalPreconditioner(Index vertices) : vertices_(vertices) {}
  /// Throws InvalidArgument, unless the matrix has as many rows of blocks as the one it was made for.
  void check_size(const BlockCsr& matrix) const;
  [[nodiscard]] Index vertices() const noexcept { return vertices_; }

 private:
  Index vertices_;
};

}  // namespace meshorder
