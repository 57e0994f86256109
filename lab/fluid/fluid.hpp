// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/fluid/fluid_order.hpp"
#include "lab/fluid/particles.hpp"
#include "lab/fluid/scalar_system.hpp"
#include "lab/fluid/triangulation.hpp"
#include "lab/motion/integrator.hpp"

#include <vector>

namespace meshorder {

/// An incompressible fluid with a free surface, by the particle finite element method (Idelsohn, Oñate, Del
/// Pin 2004): the particles are the vertices of a mesh that is made anew in each step, with linear velocities
/// and pressures.
///
/// A step computes, one after another:
/// - the alpha shape of the particles' Delaunay triangulation, and the order of the particles;
/// - the velocity after viscosity, u' with (M + τν K) u' = M u;
/// - the velocity after gravity, u* = u' + τg;
/// - the pressure p with τ/ρ ∫ ∇q·∇p = ∫ ∇q·u* for all q, and p = 0 on the free surface;
/// - the new velocity u = u* − τ/ρ ∇p;
/// - the new positions: particles move by Δt u, and slightly apart.
///
/// Velocities belong to times midway between those of positions, so τ is the mean of this Δt and the last Δt.
/// Particles in free fall thus follow a parabola, and waves keep their height. Walls have no friction:
/// ∫ ∇q·u* has no flow through walls, and particles stay on a wall that they reach.
///
/// A state has positions and velocities in the order of the particles at the start.
class Fluid : public Integrator {
 public:
  /// Throws InvalidArgument for options out of range and unknown methods, Error if the particles cannot be
  /// triangulated.
  Fluid(const FluidOptions& options, FluidOrdering ordering, Triangulate triangulate);

  /// Starts from the caller's particles instead of those of the options.
  Fluid(const FluidOptions& options, Particles particles, FluidOrdering ordering, Triangulate triangulate);

  [[nodiscard]] MotionState state() const override;
  void set_state(const MotionState& state) override;
  StepReport step() override;
  [[nodiscard]] Balance balance() const override;
  /// Returns the memory held, in bytes, without the triangulation, which another process holds.
  [[nodiscard]] std::size_t bytes() const override;

  // ---- of the last step, in the current order of the particles
  /// Returns the mesh that the step was computed on.
  [[nodiscard]] const FluidMesh& mesh() const noexcept { return mesh_; }
  /// Returns the number that each particle had at the start.
  [[nodiscard]] const std::vector<Index>& numbers() const noexcept { return numbers_; }
  [[nodiscard]] const std::vector<double>& pressures() const noexcept { return pressures_; }  ///< Pa
  /// Returns the volume of the mesh, m³.
  [[nodiscard]] double volume() const noexcept { return volume_; }
  /// Returns the volume that the particles of the mesh had at the start, m³.
  [[nodiscard]] double volume_at_start() const noexcept { return volume_at_start_; }
  [[nodiscard]] const FluidOrder& order() const noexcept { return order_; }

 private:
  void make_mesh();
  void assemble_system();
  void check_finite() const;
  void reorder();
  [[nodiscard]] double next_time_step() const;
  void add_viscosity(double kick, StepReport& report);
  void project(double kick, double dt, StepReport& report);
  void move(double dt);
  [[nodiscard]] std::vector<Point> evening() const;

  FluidOptions options_;
  Triangulate triangulate_;
  FluidOrder order_;
  Index steps_ = 0;
  double time_ = 0;
  double last_time_step_ = 0;  ///< s; 0 before the first step

  // one entry for each particle; all are reordered together
  std::vector<Point> positions_;
  std::vector<Point> velocities_;
  std::vector<double> pressures_;
  std::vector<Walls> walls_;
  std::vector<Index> numbers_;
  std::vector<double> shares_;  ///< volume that belonged to each particle at the start, m³

  FluidMesh mesh_;
  ScalarSystem system_;
  double volume_ = 0;
  double volume_at_start_ = 0;
};

}  // namespace meshorder
