// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/admm/global_system.hpp"
#include "lab/admm/local_steps.hpp"
#include "lab/contact/search/contact_set.hpp"
#include "lab/contact/solve/dual_contact_solver.hpp"
#include "lab/motion/integrator.hpp"
#include "lab/motion/loads.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace meshorder {

struct ProjectiveOptions : MotionOptions {
  int iterations = 20;  ///< of a step; if `tolerance` > 0, the maximum
  double tolerance =
      0.0;  ///< a step ends when both residuals (see ProjectiveDynamics) are below this; 0: never
  bool keep_duals = true;  ///< keeps the duals between steps; false: each step starts with duals 0
  ContactOptions contact;
  ContactSolverOptions contact_solver;
};

/// A body for projective dynamics.
struct ProjectiveBody {
  Simplices simplices;  ///< tetrahedra
  LocalLaw law;
  std::vector<double> densities;  ///< kg/m³: one, or one for each simplex
};

/// Integrates the motion of an elastic body by ADMM projective dynamics (Narain, Overby, Brown 2016), with
/// contacts after Overby, Brown, Li and Narain (2017). `Real` is the precision of an iteration, double or
/// float; positions and velocities are double.
///
/// A step of backward Euler minimises ½h⁻²‖x − x̄‖²_M + Σ Uᵢ(Dᵢx), x̄ = x + h v + h²M⁻¹f_ext. An iteration
/// first takes every element's local step, z = argmin U(z) + ½w²‖z − (Dx + u)‖² and u ← u + Dx − z, then the
/// global step, A x = M x̄ + h² Σ Dᵀw²(z − u) subject to the contacts. An iteration's residuals are
/// ‖W(Dx − z)‖ / ‖Wz‖ and the change of the right-hand side relative to the elastic part h² Σ Dᵀw²(z − u).
///
/// A step respects the contacts at its end: the last global step is repeated until no vertex violates a new
/// contact, but made eight times at most.
template <class Real>
class ProjectiveDynamics final : public Integrator {
 public:
  /// Makes the body, at rest at `points`. Throws InvalidArgument, naming the problem, for a body that does
  /// not consist of tetrahedra and for numbers that are not finite or out of range.
  ProjectiveDynamics(std::span<const Point> points, const ProjectiveBody& body, ProjectiveOptions options);

  /// Returns the state; its `memory` holds the duals if they are kept.
  [[nodiscard]] MotionState state() const override;
  void set_state(const MotionState& state) override;
  StepReport step() override;
  [[nodiscard]] Balance balance() const override;
  [[nodiscard]] std::size_t bytes() const override;

  [[nodiscard]] const LocalSteps<Real>& local_steps() const noexcept { return local_; }
  [[nodiscard]] const GlobalSystem<Real>& system() const noexcept { return system_; }
  [[nodiscard]] std::span<const double> masses() const noexcept { return masses_; }

 private:
  void predict();
  void complete_right_side();
  bool has_converged(const LocalResidual& local, StepReport& report);
  void solve(bool last, StepReport& report);
  void solve_with_contacts(bool last, StepReport& report);
  std::span<const double> in_double();
  void drop_held_contacts();
  void spread_forces();
  void finish(StepReport& report);

  ProjectiveOptions options_;
  std::vector<double> masses_;
  LocalSteps<Real> local_;
  GlobalSystem<Real> system_;
  std::optional<ContactSet> contacts_;  ///< if the body can touch something
  std::unique_ptr<DualContactSolver<Real>> contact_solver_;
  HeldVertices held_;

  Index steps_ = 0;
  AlignedVector<double> positions_;      ///< at the step's start; aligned vectors are padded
  std::vector<double> velocities_;       ///< 3 a vertex
  std::vector<double> loads_;            ///< f_ext, 3 a vertex
  AlignedVector<Real> x_;                ///< the iterate
  AlignedVector<Real> inertia_;          ///< M x̄
  AlignedVector<Real> right_side_;       ///< h² Σ Dᵀw²(z − u), then the whole right-hand side
  AlignedVector<Real> last_right_side_;  ///< of the previous iteration, if there is a tolerance
  AlignedVector<double> widened_;        ///< x_ in double, if Real is float
  std::vector<Contact> free_contacts_;   ///< contacts of vertices that are not held
  std::vector<double> contact_forces_;   ///< of all contacts, by the last global step
};

}  // namespace meshorder
