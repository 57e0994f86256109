// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/motion/loads.hpp"

#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace meshorder {

void HeldVertices::clear() {
  vertices_.clear();
  velocities_.clear();
}

void HeldVertices::hold(Index vertex, const Point& velocity) {
  vertices_.push_back(vertex);
  velocities_.push_back(velocity);
}

void HeldVertices::set(std::span<double> velocities) const {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    std::copy(velocities_[i].begin(), velocities_[i].end(), velocities.begin() + Offset{3} * vertices_[i]);
  }
}

void HeldVertices::set_zero(std::span<double> vector) const {
  for (const Index v : vertices_) std::fill_n(vector.begin() + Offset{3} * v, 3, 0.0);
}

void HeldVertices::remove_from(BlockCsr& matrix) const {
  for (const Index v : vertices_) {
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
      const Index column = matrix.columns[k];
      double* const block = matrix.values.data() + 9 * k;
      if (column == v) {
        const double mean = (block[0] + block[4] + block[8]) / 3;
        std::fill_n(block, 9, 0.0);
        for (const int i : {0, 4, 8}) block[i] = mean > 0.0 ? mean : 1.0;
      } else {
        std::fill_n(block, 9, 0.0);
        std::fill_n(matrix.values.data() + 9 * matrix.find(column, v), 9, 0.0);
      }
    }
  }
}

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
  // time bounds that are multiples of h may have rounding errors
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
