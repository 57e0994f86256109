// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "lab/implicit/elastic_system.hpp"
#include "lab/linear/cg/solve.hpp"
#include "lab/linear/preconditioners/preconditioner.hpp"
#include "lab/motion/integrator.hpp"
#include "lab/motion/loads.hpp"

#include <memory>
#include <span>
#include <vector>

namespace meshorder {

enum class MatrixPrecision : std::uint8_t {
  double_,  ///< all in double
  single,   ///< CG reads a float matrix but reaches the same residual (see refined_conjugate_gradients)
};

template <>
struct EnumNames<MatrixPrecision> {
  static constexpr std::string_view kind = "precision";
  static constexpr std::array names{std::pair{MatrixPrecision::double_, "double"},
                                    std::pair{MatrixPrecision::single, "single"}};
};

struct ImplicitOptions : MotionOptions {
  double mass_damping = 0.0;       ///< α of Rayleigh's C = αM + βK, 1/s
  double stiffness_damping = 0.0;  ///< β, s; K is that at the start of the step
  Mass mass = Mass::lumped;
  int newton_iterations = 1;       ///< 1: one linearised step (Baraff, Witkin 1998)
  double newton_tolerance = 1e-6;  ///< bound of ‖g(v)‖ / ‖g(0)‖, if more than one iteration is allowed
  PreconditionerKind preconditioner = PreconditionerKind::jacobi;
  MatrixPrecision precision = MatrixPrecision::double_;
  SolveOptions solve;
};

/// Integrates the motion of an elastic body by backward Euler.
///
/// A step solves g(v) = M(v − vₙ) − h(f_ext − f_int(xₙ + h v)) + h C v = 0 by Newton's method from v = 0. The
/// first iterate is the linearised step (M + hC + h²K) Δv = h (f_ext − f_int − h K vₙ − C vₙ). If more
/// iterations are allowed, each is damped by a line search on the potential whose gradient is g.
class BackwardEuler final : public Integrator {
 public:
  /// Makes the body, at rest at `points`. Throws InvalidArgument, naming the problem, for a body that does
  /// not consist of tetrahedra, for a vertex without mass, and for numbers that are not finite or out of
  /// range.
  BackwardEuler(std::span<const Point> points, const Body& body, ImplicitOptions options);

  [[nodiscard]] MotionState state() const override;
  void set_state(const MotionState& state) override;

  /// Takes one step. If CG meets negative curvature, uses the positive semi-definite part of the tangent
  /// instead and adds a warning.
  StepReport step() override;

  [[nodiscard]] Balance balance() const override;
  [[nodiscard]] const ElasticSystem& system() const noexcept { return system_; }
  [[nodiscard]] const ImplicitOptions& options() const noexcept { return options_; }
  /// Returns the number of blocks that a CG iteration reads: about half of the matrix where that is faster.
  [[nodiscard]] Offset blocks_read() const noexcept;

  [[nodiscard]] std::size_t bytes() const override;

 private:
  struct Iterate;
  void move_to(std::span<const double> velocities);
  void assemble(Index iteration, Tangent tangent, StepReport& report);
  void compute_gradient(Iterate& iterate);
  double potential(std::span<const double> velocities);
  void solve(Iterate& iterate, StepReport& report);
  SolveReport solve_once(Iterate& iterate, StepReport& report);
  bool search_line(Iterate& iterate, StepReport& report);

  ImplicitOptions options_;
  ElasticSystem system_;
  std::unique_ptr<Preconditioner> preconditioner_;
  // at most one of these is used: a copy of the matrix that CG reads instead of the matrix itself
  BlockCsrOf<float> rounded_;
  HalfBlockCsr half_;
  HalfBlockCsrOf<float> rounded_half_;
  bool stores_half_ = false;
  BlockCsr damping_;  ///< hβK at the step's start, if β > 0 and Newton iterates or held vertices move
  HeldVertices held_;

  Index steps_ = 0;
  AlignedVector<double> positions_;  ///< 4 a vertex
  std::vector<double> velocities_;   ///< 3 a vertex, like loads_ and scratch_
  std::vector<double> loads_;        ///< f_ext of the step
  AlignedVector<double> moved_;      ///< xₙ + h v, 4 a vertex
  std::vector<double> scratch_;
};

}  // namespace meshorder
