// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/contact_solver.hpp"

#include "base/error.hpp"
#include "lab/contact/solve/dual_contact_solver.hpp"

namespace meshorder {

template <class Real>
std::unique_ptr<ContactSolver<Real>> ContactSolver<Real>::make(const SparseMatrix& matrix,
                                                               const CholeskyFactor<Real>& factor,
                                                               const ContactSolverOptions& options) {
  if (!(options.tolerance > 0.0)) throw InvalidArgument("ContactSolver: tolerance must be positive");
  if (options.max_iterations < 0) throw InvalidArgument("ContactSolver: max_iterations must not be negative");
  if (matrix.size() != factor.size())
    throw InvalidArgument("ContactSolver: the factor must be that of the matrix");
  return make_uzawa(matrix, factor, options);
}

template class ContactSolver<double>;
template class ContactSolver<float>;

}  // namespace meshorder
