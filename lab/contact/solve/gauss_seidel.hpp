// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/solve/contact_solver.hpp"

#include <memory>

namespace meshorder {

/// The global step with contacts by sweeps over the vertices, each of which goes to the least energy with all
/// others held and no deeper than its contacts allow: nonlinear Gauss–Seidel, colour by colour on all
/// threads, with over-relaxation before the projection (Cryer 1971). The energy falls with every sweep for
/// any over-relaxation within 0 … 2.
///
/// A vertex against obstacles is projected onto what they leave of space, by duals of its contacts one after
/// the other (Hildreth 1957). Contacts of the body with itself tie vertices that A does not; they have forces
/// with a penalty (an augmented Lagrangian), their vertices are relaxed one after the other with a stiffness
/// that bounds the penalty's, and their forces follow whenever the sweeps have calmed down. So do the bounds
/// of tangential forces, from the normal ones (Tresca's fixed point).
///
/// `tolerance` is that of the change in one sweep, of the forces and of what is left of depths, all in the
/// norm of the energy, relative to the largest change in a first sweep since `forget`. Errors that are smooth
/// along the body outlast it: a sweep changes little of them. A sweep reads A once.
template <class Real>
std::unique_ptr<ContactSolver<Real>> make_gauss_seidel(const SparseMatrix& matrix,
                                                       const CholeskyFactor<Real>& factor,
                                                       const ContactSolverOptions& options);

}  // namespace meshorder
