// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "base/polymorphic.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// The state of a motion after a step.
struct MotionState {
  Index step = 0;                 ///< steps done
  double time = 0;                ///< s
  std::vector<Point> positions;   ///< m
  std::vector<Point> velocities;  ///< m/s
  /// Further numbers that an integrator keeps from step to step; may be empty.
  std::vector<double> memory = {};
};

/// Timings and iteration counts of one step. Numbers that the integrator's method does not have are 0.
struct StepReport {
  // implicit
  int newton_iterations = 0;
  int cg_iterations = 0;
  double newton_residual = 0.0;  ///< ‖g(v)‖ / ‖g(0)‖ at the end, if more than one iteration is allowed
  // ADMM
  int admm_iterations = 0;
  int contact_iterations = 0;  ///< of the solver of the global step with contacts
  Index contacts = 0;          ///< number of contacts with a force at the end of the step
  double penetration = 0.0;    ///< largest depth of a surface vertex in an obstacle at the end of the step, m
  Index vertices_in_itself = 0;  ///< number of surface vertices inside the body at the step's end

  double time_step = 0.0;             ///< s
  double residual = 0.0;              ///< of the last linear solve, or of the last ADMM iteration; relative
  std::vector<std::string> warnings;  ///< messages to users
  struct Seconds {
    double total = 0.0;
    double assembly = 0.0, solve = 0.0;                     // implicit
    double local = 0.0, global = 0.0, collision = 0.0;      // ADMM
    double triangulation = 0.0, order = 0.0, motion = 0.0;  // fluids, besides assembly and solve

    Seconds& operator+=(const Seconds& other) {
      total += other.total;
      assembly += other.assembly;
      solve += other.solve;
      local += other.local;
      global += other.global;
      collision += other.collision;
      triangulation += other.triangulation;
      order += other.order;
      motion += other.motion;
      return *this;
    }
    bool operator==(const Seconds&) const = default;
  } seconds;
};

/// The energies and momenta of a body.
struct Balance {
  double kinetic = 0.0, elastic = 0.0, potential = 0.0;  ///< J; potential: of gravity, 0 at the origin
  Point momentum{};                                      ///< kg m/s
  Point angular_momentum{};                              ///< kg m²/s, about the origin
};

/// Integrates the motion of a body. For solids, vertices and elements are processed in the given order, and
/// vertices that no element uses stay where they are. Results have the same bits on every run and for any
/// number of threads.
class Integrator : public Polymorphic {
 public:
  [[nodiscard]] virtual MotionState state() const = 0;
  /// Continues from `state`. Throws InvalidArgument if the sizes differ or a number is not finite. If
  /// `state.memory` is empty, a motion starts; a fluid throws InvalidArgument.
  virtual void set_state(const MotionState& state) = 0;

  /// Takes one time step. Throws Error, naming the vertex, if the motion is not finite; positions and
  /// velocities are then those before the step.
  virtual StepReport step() = 0;

  [[nodiscard]] virtual Balance balance() const = 0;
  /// Returns the memory held, in bytes.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// Throws InvalidArgument unless the state has n vertices, is finite and has a step of at least 0.
void check_state(const MotionState& state, Index n);

/// Returns the state of a body whose vertices have these positions (kPaddedStride numbers for each vertex,
/// see padded_positions) and velocities (3 numbers), without memory.
MotionState state_of(Index steps, double time_step, std::span<const double> positions,
                     std::span<const double> velocities);

/// Copies the positions and velocities of a state that passes `check_state` to arrays as in state_of.
void take_state(const MotionState& state, std::span<double> positions, std::span<double> velocities);

/// Returns the balance of a body whose vertices have these masses, positions (kPaddedStride numbers for each
/// vertex, see padded_positions), velocities and momenta (3 numbers). The elastic energy is left 0.
/// O(vertices).
Balance balance_of(std::span<const double> masses, std::span<const double> positions,
                   std::span<const double> velocities, std::span<const double> momenta, const Point& gravity);

}  // namespace meshorder
