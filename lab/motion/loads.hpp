// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "kernels/block_csr.hpp"

#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// The vertices whose motion in a step is prescribed, with their velocities in m/s.
class HeldVertices {
 public:
  void clear();
  /// Holds a vertex. If a vertex is held twice, the velocity given last counts.
  void hold(Index vertex, const Point& velocity);

  /// Sets the velocities of the held vertices in a vector of 3 doubles for each vertex. O(held).
  void set(std::span<double> velocities) const;
  /// Sets the entries of the held vertices to 0. O(held).
  void set_zero(std::span<double> vector) const;
  /// Returns the held vertices, in the order in which they were given.
  [[nodiscard]] std::span<const Index> vertices() const noexcept { return vertices_; }

  /// Calls `work(vertex, velocity)` for the held vertices, in the order of vertices().
  template <class Work>
  void for_each(Work work) const {
    for (std::size_t i = 0; i < vertices_.size(); ++i) work(vertices_[i], velocities_[i]);
  }

  /// Removes the rows and columns of the held vertices from a symmetric matrix: sets them to zero except for
  /// the diagonal, a multiple of the identity. With zeros on the right-hand side, held vertices do not
  /// influence the solution. O(their blocks · log row length).
  void remove_from(BlockCsr& matrix) const;

 private:
  std::vector<Index> vertices_;
  std::vector<Point> velocities_;  ///< of `vertices_`
};

/// Vertices and a time span: from the step that begins at `from` to the last step that begins before `until`.
struct Selection {
  std::vector<Index> vertices;
  double from = 0.0;  ///< s
  double until = std::numeric_limits<double>::infinity();
};

/// A force on each of the selected vertices.
struct VertexForce : Selection {
  Point newtons{};
};

/// A prescribed motion of vertices; a velocity of 0 fixes them.
struct PrescribedMotion : Selection {
  Point velocity{};  ///< m/s
};

/// Options of the motion that all integrators share.
struct MotionOptions {
  double time_step = 0.01;  ///< h, s
  Point gravity{};          ///< m/s²
  std::vector<VertexForce> forces;
  std::vector<PrescribedMotion> prescribed;
};

/// Throws InvalidArgument, naming the value, for a number that is out of range or not finite and for a vertex
/// that the mesh does not have.
void check_options(const MotionOptions& options, Index vertex_count);
/// Throws InvalidArgument with `name`, `value` and `remedy` unless `good`.
void require(bool good, const char* name, double value, const char* remedy);

/// Sets the forces, 3 numbers for each vertex, and the vertices that are held in the step after the first
/// `steps` steps. Vertices of mass 0 are held at rest. O(vertices + selected vertices).
void collect_loads(const MotionOptions& options, Index steps, std::span<const double> masses,
                   std::span<double> forces, HeldVertices& held);

}  // namespace meshorder
