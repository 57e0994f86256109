// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh/mesh.hpp>
#include <meshorder/sim/linear/preconditioner.hpp>
#include <meshorder/sim/linear/solve.hpp>
#include <meshorder/sim/material/material.hpp>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace meshorder {

/// Vertices and when: from the step that begins at `from` to the last one that begins before `until`.
struct Selection {
  std::vector<Index> vertices;  ///< rising
  double from = 0.0;            ///< s
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

enum class Mass : std::uint8_t {
  lumped,      ///< a quarter of each tetrahedron's mass on each of its corners
  consistent,  ///< ∫ρ φ_a φ_b: a matrix with the pattern of the stiffness
};

enum class MatrixPrecision : std::uint8_t {
  exact,   ///< double
  single,  ///< the matrix of CG in float, its vectors in double: 1.4 times less to read
};

struct ImplicitOptions {
  double time_step = 0.01;         ///< h, s
  double mass_damping = 0.0;       ///< α of Rayleigh's C = αM + βK, 1/s
  double stiffness_damping = 0.0;  ///< β, s
  Mass mass = Mass::lumped;
  Point gravity{};  ///< m/s²
  std::vector<VertexForce> forces;
  std::vector<PrescribedMotion> prescribed;
  int newton_iterations = 1;       ///< 1: one linearised step (Baraff, Witkin 1998)
  double newton_tolerance = 1e-6;  ///< on ‖g‖ / ‖g at the start of the step‖, where more are allowed
  PreconditionerKind preconditioner = PreconditionerKind::jacobi;
  MatrixPrecision precision = MatrixPrecision::exact;
  SolveOptions solve;
};

/// What a mesh is made of: one law for all its simplices, with the densities.
struct Body {
  Simplices simplices;  ///< tetrahedra
  Elasticity elasticity;
  std::vector<double> densities;  ///< kg/m³: one, or one for each simplex
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
  double residual = 0.0;              ///< of the last linear solve, relative
  std::vector<std::string> warnings;  ///< sentences that say which vertex or element
  struct Seconds {
    double total = 0.0, assembly = 0.0, solve = 0.0;
  } seconds;
};

/// Conserved quantities.
struct Balance {
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;  ///< J; potential is gravity's
  Point momentum{};                                      ///< kg m/s
  Point angular_momentum{};                              ///< kg m²/s, about the origin
};

/// An elastic body in time by backward Euler. It takes the vertices and simplices in the order in which they
/// come. The same bits on every run and for any number of threads.
///
/// A step solves g(v) = M(v − vₙ) − h(f_ext − f_int(xₙ + h v)) + h C v = 0 by Newton's method from v = 0,
/// whose first iterate is the linearised step (M + hC + h²K) Δv = h (f_ext − f_int − h K vₙ − C vₙ).
class BackwardEuler {
 public:
  /// The body at rest at `points`. Throws InvalidArgument, which names what is wrong, for a body that is not
  /// of tetrahedra or has no volume, numbers that are not finite or out of range.
  BackwardEuler(std::vector<Point> points, Body body, ImplicitOptions options);
  ~BackwardEuler();
  BackwardEuler(BackwardEuler&&) noexcept;
  BackwardEuler& operator=(BackwardEuler&&) noexcept;
  BackwardEuler(const BackwardEuler&) = delete;
  BackwardEuler& operator=(const BackwardEuler&) = delete;

  [[nodiscard]] MotionState state() const;
  /// Goes on from there. Throws InvalidArgument when the sizes differ or a number is not finite.
  void set_state(const MotionState& state);

  /// One time step. Throws Error, which says which vertex or element, when it cannot be done: a state that is
  /// not finite. The state is then that before the step.
  StepReport step();

  [[nodiscard]] Balance balance() const;

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace meshorder
