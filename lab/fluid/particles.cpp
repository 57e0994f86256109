// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/fluid/particles.hpp"

#include "base/memory.hpp"
#include "base/random.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace meshorder {
namespace {

/// Bytes of memory for a particle in all processes: its share of mesh, triangulation and arrays of a step.
constexpr double kBytesOfParticle = 2500;
/// There are six or seven tetrahedra for each particle, and an Index must also count their corners.
constexpr Index kMostParticles = kMaxIndex / 32;
constexpr double kSame = 1e-9;  ///< lengths with a smaller relative difference are the same

bool fills(const FluidOptions& options, int axis) {
  return options.column[axis] >= options.basin[axis] * (1 - kSame);
}
bool has_far_wall(const FluidOptions& options, int axis) { return axis != 1 || options.lid; }

Index intervals(const FluidOptions& options, int axis) {
  return std::max(Index{1}, static_cast<Index>(std::lround(options.column[axis] / options.spacing)));
}

}  // namespace

Particles particles_at_start(const FluidOptions& options) {
  check_options(options);
  std::array<Index, 3> counts{};
  for (int axis = 0; axis < 3; ++axis) counts[axis] = intervals(options, axis);
  Particles particles;
  Random random(1);
  std::array<Index, 3> at{};
  const auto add = [&] {
    Point position{};
    Walls walls = kNoWalls;
    for (int axis = 0; axis < 3; ++axis) {
      position[axis] = options.column[axis] * at[axis] / counts[axis];
      const double moved = options.jitter * (2 * random.unit() - 1) * options.spacing;
      if (at[axis] == 0) walls |= wall(axis, false);
      if (at[axis] == counts[axis] && fills(options, axis) && has_far_wall(options, axis))
        walls |= wall(axis, true);
      if (at[axis] > 0 && at[axis] < counts[axis]) position[axis] += moved;
    }
    position[1] *= 1 + options.wave * std::cos(std::numbers::pi * position[0] / options.column[0]);
    particles.positions.push_back(position);
    particles.walls.push_back(walls);
  };
  for (at[0] = 0; at[0] <= counts[0]; ++at[0]) {
    for (at[1] = 0; at[1] <= counts[1]; ++at[1]) {
      for (at[2] = 0; at[2] <= counts[2]; ++at[2]) add();
    }
  }
  return particles;
}

void keep_inside(const FluidOptions& options, Point& position, Walls& walls) {
  for (int axis = 0; axis < 3; ++axis) {
    if (position[axis] <= 0) {
      position[axis] = 0;
      walls |= wall(axis, false);
    } else if (position[axis] >= options.basin[axis] && has_far_wall(options, axis)) {
      position[axis] = options.basin[axis];
      walls |= wall(axis, true);
    }
  }
}

void check_options(const FluidOptions& options) {
  const auto is_positive = [](double x) { return x > 0 && std::isfinite(x); };
  const auto require_range = [](const char* name, double value, double low, double high, const char* range) {
    require(value >= low && value <= high, name, value, range);
  };
  require(is_positive(options.time_step), "the time step", options.time_step, "positive");
  require(is_positive(options.spacing), "the spacing", options.spacing, "positive");
  double particles = 1;
  for (int axis = 0; axis < 3; ++axis) {
    require(is_positive(options.basin[axis]), "the basin", options.basin[axis], "positive");
    require(is_positive(options.column[axis]), "the column", options.column[axis], "positive");
    require(options.column[axis] <= options.basin[axis] * (1 + kSame) || !has_far_wall(options, axis),
            "the column", options.column[axis], "no larger than the basin");
    particles *= options.column[axis] / options.spacing + 1;
  }
  const auto limit = static_cast<double>(memory_limit().bytes);
  if (particles * kBytesOfParticle > limit || particles > kMostParticles)
    throw InvalidArgument(fmt::format("a spacing of {} makes {:.2g} particles; memory is enough for {:.2g}",
                                      options.spacing, particles,
                                      std::min(limit / kBytesOfParticle, double{kMostParticles})));
  require(is_positive(options.density), "the density", options.density, "positive");
  require_range("the jitter", options.jitter, 0, 0.4, "0 to 0.4");
  require_range("the wave", options.wave, -0.9, 0.9, "-0.9 to 0.9");
  require(!options.lid || options.wave == 0, "the wave", options.wave, "0 under a lid");
  require_range("the viscosity", options.viscosity, 0, 1e9, "0 or more");
  require(options.courant > 0 && options.courant <= 1, "the courant number", options.courant,
          "above 0, up to 1");
  require_range("evening", options.evening, 0, 0.4, "0 to 0.4");
  require_range("the volume gain", options.volume_gain, 0, 1, "0 to 1");
}

}  // namespace meshorder
