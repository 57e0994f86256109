// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "lab/linear/cg/solve.hpp"
#include "lab/motion/loads.hpp"

#include <cstdint>
#include <vector>

namespace meshorder {

/// Water in a basin with plane walls, and the options of its simulation. `MotionOptions::time_step` is the
/// longest step; forces and prescribed motions are not used.
struct FluidOptions : MotionOptions {
  Point basin{};          ///< its extent from the origin, m: y is the height of its walls
  bool lid = false;       ///< whether the basin is closed at the top
  Point column{};         ///< extent of the water in the corner at the origin, m
  double spacing = 0;     ///< of the particles at the start, m
  double jitter = 0.2;    ///< largest shift of a particle along each axis at the start, in spacings
  double wave = 0;        ///< amplitude of the surface's wave cos(πx / L), as a share of the column's height
  double density = 1000;  ///< kg/m³
  double viscosity = 0;   ///< kinematic, m²/s
  double courant = 0.5;   ///< largest distance that a particle moves in a step, in spacings
  double evening = 0.05;  ///< largest shift along each axis to even out distances, in spacings
  double volume_gain = 0.2;  ///< share of lost volume that a step restores
  SolveOptions solve{.tolerance = 1e-5, .max_iterations = 2000};  ///< for pressure and viscosity
};

/// Number of particles, or tetrahedra, in a chunk: threads take one chunk at a time, sums are made by chunk.
inline constexpr Index kParticlesInChunk = 1 << 12;

/// The walls on which a particle lies, as bits; the particle moves only along them. Bit 2 · axis is the wall
/// at 0, bit 2 · axis + 1 the wall at the basin's extent.
using Walls = std::uint8_t;
inline constexpr Walls kNoWalls = 0;

/// Returns the wall across an axis, at 0 or at the basin's extent.
constexpr Walls wall(int axis, bool at_extent) {
  return static_cast<Walls>(1U << static_cast<unsigned>(2 * axis + (at_extent ? 1 : 0)));
}
/// Returns whether a particle may not move along an axis.
constexpr bool is_held(Walls walls, int axis) {
  return (walls & (wall(axis, false) | wall(axis, true))) != 0;
}

struct Particles {
  std::vector<Point> positions;  ///< m
  std::vector<Walls> walls;
};

/// Returns the particles at the start: a lattice, row by row along z, with inner coordinates shifted by the
/// jitter. Throws InvalidArgument as `check_options` does. O(particles).
Particles particles_at_start(const FluidOptions& options);

/// Moves a particle that left the basin back to the wall, on which the particle then stays.
void keep_inside(const FluidOptions& options, Point& position, Walls& walls);

/// Throws InvalidArgument, naming the value, for options out of range and for more particles than the memory
/// limit allows.
void check_options(const FluidOptions& options);

}  // namespace meshorder
