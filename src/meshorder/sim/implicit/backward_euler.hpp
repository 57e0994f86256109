// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/base/error.hpp>
#include <meshorder/sim/implicit/elastic_system.hpp>
#include <meshorder/sim/implicit/held_vertices.hpp>
#include <meshorder/sim/linear/preconditioner.hpp>
#include <meshorder/sim/linear/solve.hpp>

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Vertices and when: from the step that begins at `from` to the last one that begins before `until`.
struct Selection {
  std::vector<Index> vertices;
  double from = 0.0;  ///< s
  double until = std::numeric_limits<double>::infinity();
};

/// The same force on each of some vertices.
struct VertexForce : Selection {
  Point newtons{};
};

/// Vertices that move by rule: fixed where they are when the velocity is 0.
struct PrescribedMotion : Selection {
  Point velocity{};  ///< m/s
};

enum class MatrixPrecision : std::uint8_t {
  exact,   ///< double
  single,  ///< CG reads the matrix in float, to the same residual (see refined_conjugate_gradients)
};

struct ImplicitOptions {
  double time_step = 0.01;         ///< h, s
  double mass_damping = 0.0;       ///< α of Rayleigh's C = αM + βK, 1/s
  double stiffness_damping = 0.0;  ///< β, s; K is that at the start of the step
  Mass mass = Mass::lumped;
  Point gravity{};  ///< m/s²
  std::vector<VertexForce> forces;
  std::vector<PrescribedMotion> prescribed;
  int newton_iterations = 1;       ///< 1: one linearised step (Baraff, Witkin 1998)
  double newton_tolerance = 1e-6;  ///< on ‖g‖ / ‖g at rest‖, where more iterations are allowed
  PreconditionerKind preconditioner = PreconditionerKind::jacobi;
  MatrixPrecision precision = MatrixPrecision::exact;
  SolveOptions solve;
};

/// Where everything is and how fast.
struct MotionState {
  Index step = 0;                 ///< steps done
  double time = 0;                ///< s
  std::vector<Point> positions;   ///< m
  std::vector<Point> velocities;  ///< m/s
};

struct StepReport {
  int newton_iterations = 0;
  int cg_iterations = 0;
  double residual = 0.0;         ///< of the last linear solve, relative
  double newton_residual = 0.0;  ///< ‖g‖ / ‖g at rest‖ at the end, where more iterations are allowed
  std::vector<std::string> warnings;  ///< sentences that say which vertex
  struct Seconds {
    double total = 0.0, assembly = 0.0, solve = 0.0;
  } seconds;
};

/// Conserved quantities.
struct Balance {
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;  ///< J; potential is gravity's, 0 at the origin
  Point momentum{};                                      ///< kg m/s
  Point angular_momentum{};                              ///< kg m²/s, about the origin
};

/// An elastic body in time by backward Euler. It takes the vertices and simplices in the order in which they
/// come. Vertices that no tetrahedron uses stay where they are. The same bits on every run and for any number
/// of threads.
///
/// A step solves g(v) = M(v − vₙ) − h(f_ext − f_int(xₙ + h v)) + h C v = 0 by Newton's method from v = 0,
/// whose first iterate is the linearised step (M + hC + h²K) Δv = h (f_ext − f_int − h K vₙ − C vₙ). Where
/// more iterations are allowed each is damped by a line search on the potential of which g is the gradient.
class BackwardEuler {
 public:
  /// The body at rest at `points`. Throws InvalidArgument, which names what is wrong, for a body that is not
  /// of tetrahedra, a vertex without mass, numbers that are not finite or out of range.
  BackwardEuler(std::span<const Point> points, const Body& body, ImplicitOptions options);

  [[nodiscard]] MotionState state() const;
  /// Goes on from there. Throws InvalidArgument when the sizes differ or a number is not finite.
  void set_state(const MotionState& state);

  /// One time step. Where CG meets negative curvature the step is taken with the tangent's semi-definite part
  /// instead, and says so. Throws Error, which says which vertex, when the motion is not finite any more. The
  /// state is then that before the step.
  StepReport step();

  [[nodiscard]] Balance balance() const;
  [[nodiscard]] const ElasticSystem& system() const noexcept { return system_; }
  [[nodiscard]] const ImplicitOptions& options() const noexcept { return options_; }

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Iterate;
  void collect_loads();
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
  BlockCsrOf<float> rounded_;  ///< the matrix in single precision, where CG reads that
  BlockCsr damping_;  ///< hβK of the step's start; empty but for several Newton iterations with β > 0
  HeldVertices held_;
  std::vector<Index> unused_;  ///< vertices of no tetrahedron

  Index steps_ = 0;
  AlignedVector<double> positions_;  ///< 4 a vertex
  std::vector<double> velocities_;   ///< 3 a vertex, as below
  std::vector<double> loads_;        ///< f_ext of the step
  AlignedVector<double> moved_;      ///< xₙ + h v, 4 a vertex
  std::vector<double> scratch_;
};

}  // namespace meshorder
