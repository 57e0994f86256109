// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/contact.hpp"
#include "lab/linear/cholesky/cholesky.hpp"

#include <memory>
#include <span>
#include <vector>

namespace meshorder {

struct ContactSolverOptions {
  double tolerance = 1e-3;   ///< > 0, relative, of the residual; see make_uzawa
  int max_iterations = 200;  ///< of one call: multiplications by A⁻¹ at contacts
};

struct ContactSolveReport {
  int iterations = 0;
  double residual = 0.0;  ///< relative
  bool converged = false;
  double violation = 0.0;  ///< the deepest that a contact is left violated, m
  Index pushing = 0;       ///< contacts with a force
};

/// The global step with contacts: minimises ½xᵀA x − bᵀx over normal · Σ w x ≥ offset of every contact.
/// Contacts push and never pull; with friction the force along the surface is at most the coefficient times
/// the force across it, and opposes the motion since `from`.
template <class Real>
class ContactSolver {
 public:
  /// `matrix` and its `factor` must outlive it. Throws InvalidArgument for options that are out of range and
  /// for a factor of another size.
  static std::unique_ptr<ContactSolver> make(const SparseMatrix& matrix, const CholeskyFactor<Real>& factor,
                                             const ContactSolverOptions& options);
  ContactSolver() = default;
  ContactSolver(const ContactSolver&) = delete;
  ContactSolver(ContactSolver&&) = delete;
  ContactSolver& operator=(const ContactSolver&) = delete;
  ContactSolver& operator=(ContactSolver&&) = delete;
  virtual ~ContactSolver() = default;

  /// x, which holds a first guess, becomes the solution; without contacts A⁻¹b exactly. Vectors have
  /// kPaddedStride numbers for each vertex. Forces of the last call serve as a first guess for contacts with
  /// the same vertex and obstacle, until `forget`. Throws InvalidArgument for contacts of vertices that do
  /// not exist and numbers that are out of range. Whatever the contacts are, it ends and says in the report
  /// what is left.
  virtual ContactSolveReport solve(std::span<const Contact> contacts, std::span<const Real> b,
                                   std::span<const double> from, std::span<Real> x) = 0;

  /// The normal force of each contact of the last call, in units of A x, none negative.
  [[nodiscard]] virtual std::span<const double> forces() const = 0;

  /// Starts a step: forces of earlier ones are forgotten.
  virtual void forget() = 0;

  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

}  // namespace meshorder
