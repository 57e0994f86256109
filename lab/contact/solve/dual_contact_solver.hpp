// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/solve/contact_solver.hpp"

#include <memory>

namespace meshorder {

/// The global step with contacts by its dual problem, after Uzawa: the forces λ of contacts minimise
/// ½λᵀSλ − gᵀλ with S = C A⁻¹Cᵀ and g how deep contacts are without forces, and x = A⁻¹(b + Cᵀλ). A
/// multiplication by S takes one solve with the factor on what contacts reach of it, and minimise_forces
/// needs few, since forces start from the last call's and its preconditioner is the part of A at contacts'
/// vertices (the lumped one of FETI: Farhat, Roux 1991). Beside these a call takes two solves with the whole
/// factor.
///
/// `tolerance` is that of the projected gradient's norm relative to that of the depths g > 0: about the error
/// of places of contacts relative to the depth without forces. Where contacts contradict or repeat each
/// other, each gives way by tolerance / 100 of what its force moves its own vertex: repeated ones share the
/// force, contradicting ones end between each other, with `converged` false and the rest in `violation`.
///
/// With friction the bounds of tangential forces are those of the last round's normal forces (Tresca's fixed
/// point; Haslinger 1983), until forces are within `tolerance` with the bounds that they make themselves.
/// Where rounds do not get there (a body may jam), the last bounds stay for good: tangential forces may then
/// be beyond their cones, and `converged` is false.
template <class Real>
std::unique_ptr<ContactSolver<Real>> make_uzawa(const SparseMatrix& matrix,
                                                const CholeskyFactor<Real>& factor,
                                                const ContactSolverOptions& options);

}  // namespace meshorder
