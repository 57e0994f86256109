// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/polymorphic.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Bounds of contact forces λ. First, λ has one number for each contact: the force along the normal, at least
/// 0. Then λ has two numbers for each contact with friction: the force along the surface, in a disc about 0.
struct ForceBounds {
  Index normals = 0;
  std::vector<double> radii;  ///< of the discs, each at least 0

  [[nodiscard]] Index size() const noexcept { return normals + 2 * index_size(radii); }
};

/// The symmetric positive semidefinite matrix S that maps contact forces to displacements.
class ForceOperator : public Polymorphic {
 public:
  /// Computes result = S forces.
  virtual void multiply(std::span<const double> forces, std::span<double> result) = 0;

  /// Computes result ≈ S⁻¹ moves, by a symmetric matrix.
  virtual void precondition(std::span<const double> moves, std::span<double> result) = 0;
};

struct ForceSolveOptions {
  double tolerance = 0.0;       ///< bound of the projected gradient's norm, in units of S λ
  int max_multiplications = 0;  ///< by S
  /// A positive scale of each row of S, such as an estimate of its diagonal entry.
  std::span<const double> scale;
  /// The solver adds softness · scale to the diagonal of S, so that the solution is unique for a singular S.
  double softness = 0.0;
};

struct ForceSolveReport {
  int multiplications = 0;
  double residual = 0.0;  ///< the projected gradient's norm, softness included
};

/// Minimises ½λᵀSλ − gᵀλ within the bounds. Updates `forces`, a feasible λ, and `gradient`, which is g − S λ.
///
/// Each step selects the positive forces. It also selects the forces that are 0 and would grow, if they
/// promise a larger gain than the positive forces. It solves for the selected forces by conjugate gradients
/// without bounds, to a tenth of the residual, and projects the result onto the bounds. This is a primal–dual
/// active set (Hintermüller, Ito, Kunisch 2003) with the proportioning of Dostál and Schöberl (2005). The
/// energy may increase temporarily. After some steps without a new minimum, the next step starts from the
/// minimum and is halved until the energy decreases enough (a projected Newton step: Bertsekas 1982), so that
/// the energy converges for any S. A force on the rim of its disc moves along the rim. If the method does not
/// converge within `max_multiplications`, or if a number is not finite, λ is the best result so far. Runs on
/// one thread; takes O(size) besides S.
ForceSolveReport minimise_forces(ForceOperator& matrix, const ForceBounds& bounds,
                                 const ForceSolveOptions& options, std::span<double> forces,
                                 std::span<double> gradient);

/// Replaces the forces by the nearest forces within the bounds.
void project(const ForceBounds& bounds, std::span<double> forces);

/// Returns the norm of the projected gradient, in units of S λ; 0 only at the minimum. For a normal force
/// this is the part of g − S λ along which the force can move. For a force in a disc it is scale · ‖λ − P(λ +
/// gradient / scale)‖, where P is the projection; this norm is continuous where forces leave the rim.
double projected_gradient(const ForceBounds& bounds, std::span<const double> scale,
                          std::span<const double> forces, std::span<const double> gradient);

}  // namespace meshorder
