// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/motion/held_vertices.hpp"

#include <limits>
#include <span>
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

/// What every integrator is told of the motion.
struct MotionOptions {
  double time_step = 0.01;  ///< h, s
  Point gravity{};          ///< m/s²
  std::vector<VertexForce> forces;
  std::vector<PrescribedMotion> prescribed;
};

/// Throws InvalidArgument, which names it, for a number that is out of range or not finite and for a vertex
/// that is none of the mesh's.
void check_options(const MotionOptions& options, Index vertex_count);
/// Throws InvalidArgument that tells what `value` `name` has, unless it is `good`.
void require(bool good, const char* name, double value, const char* remedy);

/// Sets the forces, 3 numbers for each vertex, and the vertices that are held in the step after `steps` ones.
/// Vertices of mass 0 are held at rest. O(vertices + selected ones).
void collect_loads(const MotionOptions& options, Index steps, std::span<const double> masses,
                   std::span<double> forces, HeldVertices& held);

}  // namespace meshorder
