// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "base/polymorphic.hpp"
#include "base/text.hpp"
#include "kernels/block_csr.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace meshorder {

/// Approximates the inverse of a symmetric positive definite matrix of 3×3 blocks. The approximation is
/// symmetric and positive definite, too. Results have the same bits for any number of threads.
class Preconditioner : public Polymorphic {
 public:
  /// Makes a preconditioner for matrices with this number of rows of blocks.
  explicit Preconditioner(Index size) : size_(size) {}

  /// Takes the values of a matrix with the preconditioner's pattern. Call it before `apply`, and again after
  /// the matrix has changed. Throws InvalidArgument for another size (see also make_preconditioner).
  void update(const BlockCsr& matrix);

  /// Computes z ≈ A⁻¹ r, 3 doubles for each vertex. Throws InvalidArgument if a size differs, and in
  /// multigrid before the first update.
  void apply(std::span<const double> r, std::span<double> z) const;

  /// Returns the memory held, in bytes.
  [[nodiscard]] virtual std::size_t bytes() const = 0;

 protected:
  [[nodiscard]] Index size() const noexcept { return size_; }

 private:
  /// Do the work of `update` and `apply`; the arguments have the right size.
  virtual void take(const BlockCsr& matrix) = 0;
  virtual void multiply(std::span<const double> r, std::span<double> z) const = 0;

  Index size_;
};

enum class PreconditionerKind : std::uint8_t {
  jacobi,               ///< the diagonal
  block_jacobi,         ///< the 3×3 blocks of the diagonal
  incomplete_cholesky,  ///< L D Lᵀ in the pattern of A, by blocks
  multigrid,            ///< a cycle over aggregates with rigid-body modes (see make_multigrid)
};

template <>
struct EnumNames<PreconditionerKind> {
  static constexpr std::string_view kind = "preconditioner";
  static constexpr std::array names{std::pair{PreconditionerKind::jacobi, "jacobi"},
                                    std::pair{PreconditionerKind::block_jacobi, "block-jacobi"},
                                    std::pair{PreconditionerKind::incomplete_cholesky, "incomplete-cholesky"},
                                    std::pair{PreconditionerKind::multigrid, "multigrid"}};
};

/// Returns a preconditioner for matrices of this pattern. `points` are the positions of the vertices at rest,
/// from which multigrid computes its rigid-body modes. Throws InvalidArgument if the numbers of points and
/// rows differ. If a row lacks its diagonal, this function or `update` throws.
std::unique_ptr<Preconditioner> make_preconditioner(PreconditionerKind kind, const BlockCsr& pattern,
                                                    std::span<const Point> points);

}  // namespace meshorder
