// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "kernels/block_csr.hpp"

#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// The vertices whose motion in a step is given, and with what velocity they move.
class HeldVertices {
 public:
  void clear();
  /// Held twice, a vertex has the later velocity.
  void hold(Index vertex, const Point& velocity);

  /// Gives the held vertices their velocities, in 3 doubles for each vertex. O(held).
  void set(std::span<double> velocities) const;
  /// Sets their entries to 0. O(held).
  void set_zero(std::span<double> vector) const;
  /// Those held, in the order in which they were given.
  [[nodiscard]] std::span<const Index> vertices() const noexcept { return vertices_; }

  /// Calls `work(vertex, velocity)` for them in that order.
  template <class Work>
  void for_each(Work work) const {
    for (std::size_t i = 0; i < vertices_.size(); ++i) work(vertices_[i], velocities_[i]);
  }

  /// Takes their rows and columns out of a symmetric matrix: zero but for the diagonal, a multiple of the
  /// identity. With zeros on the right-hand side they take no part. O(their blocks · log row length).
  void remove_from(BlockCsr& matrix) const;

 private:
  std::vector<Index> vertices_;
  std::vector<Point> velocities_;  ///< of `vertices_`
};

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
