// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/motion/loads.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace meshorder {

void require(bool good, const char* name, double value, const char* remedy) {
  if (!good) throw InvalidArgument(fmt::format("{} is {}; it must be {}", name, value, remedy));
}

void check_options(const MotionOptions& options, Index vertex_count) {
  require(options.time_step > 0.0 && std::isfinite(options.time_step), "the time step", options.time_step,
          "positive");
  for (const double c : options.gravity) require(std::isfinite(c), "gravity", c, "finite");
  const auto check_selection = [&](const Selection& selection, const Point& value) {
    for (const Index v : selection.vertices) {
      require(v >= 0 && v < vertex_count, "a vertex of a force or motion", v, "one of the mesh");
    }
    for (const double c : value) require(std::isfinite(c), "a force or velocity", c, "finite");
  };
  for (const VertexForce& force : options.forces) check_selection(force, force.newtons);
  for (const PrescribedMotion& motion : options.prescribed) check_selection(motion, motion.velocity);
}

void collect_loads(const MotionOptions& options, Index steps, std::span<const double> masses,
                   std::span<double> forces, HeldVertices& held) {
  const double h = options.time_step;
  // bounds that are meant to be a multiple of h may be off by rounding
  const auto acts = [&](const Selection& selection) {
    const double now = h * steps + 1e-9 * h;
    return selection.from <= now && now < selection.until;
  };
  const auto n = static_cast<Index>(masses.size());
  for (Index v = 0; v < n; ++v) {
    for (int c = 0; c < 3; ++c) forces[Offset{3} * v + c] = masses[v] * options.gravity[c];
  }
  for (const VertexForce& force : options.forces) {
    if (!acts(force)) continue;
    for (const Index v : force.vertices) {
      for (int c = 0; c < 3; ++c) forces[Offset{3} * v + c] += force.newtons[c];
    }
  }
  held.clear();
  for (Index v = 0; v < n; ++v) {
    if (!(masses[v] > 0.0)) held.hold(v, Point{});
  }
  for (const PrescribedMotion& motion : options.prescribed) {
    if (!acts(motion)) continue;
    for (const Index v : motion.vertices) held.hold(v, motion.velocity);
  }
}

}  // namespace meshorder
