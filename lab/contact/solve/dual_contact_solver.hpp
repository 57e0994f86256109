// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/polymorphic.hpp"
#include "lab/contact/search/contact.hpp"
#include "lab/linear/cholesky/cholesky.hpp"

#include <memory>
#include <span>
#include <vector>

namespace meshorder {

struct ContactSolverOptions {
  double tolerance = 1e-3;   ///< bound of the relative residual, > 0; see DualContactSolver
  int max_iterations = 200;  ///< of one call: multiplications by S, see DualContactSolver
};

struct ContactSolveReport {
  int iterations = 0;
  double residual = 0.0;  ///< relative, see DualContactSolver
  bool converged = false;
  double violation = 0.0;  ///< largest remaining depth of a contact, m
  Index pushing = 0;       ///< number of contacts with a normal force
};

/// Solves the global step with contacts: minimises ½xᵀA x − bᵀx subject to normal · Σ w x ≥ offset for every
/// contact. Contacts push and never pull. With friction the force along the surface is at most the
/// coefficient times the normal force, and opposes the motion since `from`.
///
/// Solves the dual problem: the contact forces λ minimise ½λᵀSλ − gᵀλ with S = C A⁻¹Cᵀ and g the depths of
/// the contacts without forces; then x = A⁻¹(b + Cᵀλ). ("Uzawa" in scenarios means "dual".) A multiplication
/// by S takes one solve with the part of the factor that contacts reach. minimise_forces needs few
/// multiplications, since forces start from those of the last call and the preconditioner is the part of A at
/// the contacts' vertices (the lumped preconditioner of FETI: Farhat, Roux 1991). A call takes one or two
/// more solves with the whole factor.
///
/// `tolerance` bounds the norm of the projected gradient relative to the norm of the positive depths g: about
/// the error of the contacts' positions relative to the depth without forces. Where contacts contradict or
/// repeat each other, each may stay as deep as tolerance / 100 times the distance by which its force moves
/// its vertex. Repeated contacts share the force. For contradicting contacts, the solution lies between them,
/// `converged` is false, and `violation` is the remaining depth.
///
/// With friction, each round bounds the tangential forces by the last round's normal forces (Tresca's fixed
/// point; Haslinger 1983), until the forces meet `tolerance` with the bounds that they imply. If the rounds
/// do not converge (a body may jam), the last bounds are kept: tangential forces may then lie outside their
/// cones, and `converged` is false.
template <class Real>
class DualContactSolver : public Polymorphic {
 public:
  /// `matrix` and its `factor` must outlive the solver. Throws InvalidArgument for options out of range and
  /// for a factor of another size.
  static std::unique_ptr<DualContactSolver> make(const SparseMatrix& matrix,
                                                 const CholeskyFactor<Real>& factor,
                                                 const ContactSolverOptions& options);

  /// Sets x to the solution; without contacts, the solution is A⁻¹b. Vectors have kPaddedStride numbers for
  /// each vertex. The forces of the last call are the first guess for contacts with the same first vertex and
  /// obstacle, until `forget`. Throws InvalidArgument as check_contacts does, and for vectors of other sizes.
  /// Always terminates; the report gives the remaining residual.
  virtual ContactSolveReport solve(std::span<const Contact> contacts, std::span<const Real> b,
                                   std::span<const double> from, std::span<Real> x) = 0;

  /// Returns the normal force of each contact of the last call, in units of A x, none negative.
  [[nodiscard]] virtual std::span<const double> forces() const = 0;

  /// Forgets the forces of earlier calls. Call it at the start of a step.
  virtual void forget() = 0;

  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

}  // namespace meshorder
