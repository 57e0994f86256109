// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/polymorphic.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// What forces of contacts may be: first one number for each contact, its force along the normal, at least 0;
/// then for each contact with friction two, its force along the surface, in a disc about 0.
struct ForceBounds {
  Index normals = 0;
  std::vector<double> radii;  ///< of the discs, each at least 0

  [[nodiscard]] Index size() const noexcept { return normals + 2 * index_size(radii); }
};

/// How forces move contacts: a symmetric positive semidefinite matrix S.
class ForceOperator : public detail::Polymorphic {
 public:
  /// result = S forces
  virtual void multiply(std::span<const double> forces, std::span<double> result) = 0;

  /// result = about S⁻¹ moves, by a symmetric matrix.
  virtual void precondition(std::span<const double> moves, std::span<double> result) = 0;
};

struct ForceSolveOptions {
  double tolerance = 0.0;       ///< of the projected gradient's norm, in units of S λ
  int max_multiplications = 0;  ///< by S
  /// A positive scale of each row of S, such as about its diagonal.
  std::span<const double> scale;
  /// Each force gives way by this part of scale · force: where S is singular the problem still has one
  /// solution.
  double softness = 0.0;
};

struct ForceSolveReport {
  int multiplications = 0;
  double residual = 0.0;  ///< the projected gradient's norm, softness included
};

/// Minimises ½λᵀSλ − gᵀλ within the bounds, from λ (feasible) to λ; `gradient` is g − S λ before and after.
///
/// Again and again it takes forces that push, and those that want to where these have more to gain, solves
/// for them by conjugate gradients as though they had no bounds, to a tenth of the residual, and goes to the
/// nearest forces within the bounds: a primal–dual active set (Hintermüller, Ito, Kunisch 2003) with the
/// proportioning of Dostál and Schöberl (2005). Energy may rise on the way. Where it has not fallen below its
/// lowest for some steps, the next one starts from there and is halved until it falls by enough (a projected
/// Newton step: Bertsekas 1982), so that the energy converges whatever S is. A force on the rim of its disc
/// moves along the rim. If it does not get there within the multiplications, or numbers fail, λ is the best
/// so far. Serial, O(size) beside S.
ForceSolveReport minimise_forces(ForceOperator& matrix, const ForceBounds& bounds,
                                 const ForceSolveOptions& options, std::span<double> forces,
                                 std::span<double> gradient);

/// The nearest forces within the bounds.
void project(const ForceBounds& bounds, std::span<double> forces);

/// How far forces are from the least energy, in units of S λ; 0 there alone. A normal force counts the part
/// of its gradient g − S λ along which it can move; one in a disc counts scale · ‖λ − P(λ + gradient /
/// scale)‖ with P the projection, which does not jump where forces leave the rim.
double projected_gradient(const ForceBounds& bounds, std::span<const double> scale,
                          std::span<const double> forces, std::span<const double> gradient);

}  // namespace meshorder
