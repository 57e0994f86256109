// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/preconditioners/preconditioner.hpp"

#include "lab/linear/multigrid/multigrid.hpp"
#include "lab/linear/preconditioners/incomplete_cholesky.hpp"
#include "lab/linear/preconditioners/jacobi.hpp"
#include <meshorder/error.hpp>

#include <string>

namespace meshorder {

void Preconditioner::update(const BlockCsr& matrix) {
  if (matrix.size() != size_) {
    throw InvalidArgument("preconditioner: made for " + std::to_string(size_) + " vertices, the matrix has " +
                          std::to_string(matrix.size()));
  }
  take(matrix);
}

void Preconditioner::apply(std::span<const double> r, std::span<double> z) const {
  const auto entries = 3 * static_cast<std::size_t>(size_);
  if (r.size() != entries || z.size() != entries) {
    throw InvalidArgument("preconditioner: r and z must hold 3 doubles for each vertex");
  }
  multiply(r, z);
}

std::unique_ptr<Preconditioner> make_preconditioner(PreconditionerKind kind, const BlockCsr& pattern,
                                                    std::span<const Point> points) {
  if (points.size() != static_cast<std::size_t>(pattern.size())) {
    throw InvalidArgument("preconditioner: " + std::to_string(points.size()) + " points for a matrix of " +
                          std::to_string(pattern.size()) + " vertices");
  }
  switch (kind) {
    case PreconditionerKind::jacobi:
      return std::make_unique<Jacobi>(pattern.size());
    case PreconditionerKind::block_jacobi:
      return std::make_unique<BlockJacobi>(pattern.size());
    case PreconditionerKind::incomplete_cholesky:
      return std::make_unique<IncompleteCholesky>(pattern);
    case PreconditionerKind::multigrid:
      return make_multigrid(pattern, points);
  }
  throw InvalidArgument("preconditioner: unknown kind");
}

}  // namespace meshorder
