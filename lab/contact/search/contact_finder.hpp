// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/simplices.hpp"
#include "lab/contact/geometry/box_tree.hpp"
#include "lab/contact/obstacles/obstacle.hpp"
#include "lab/contact/search/contact.hpp"
#include "lab/contact/search/self_contact.hpp"

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace meshorder {

struct ContactOptions {
  /// An obstacle with its coefficient of friction.
  struct With {
    std::shared_ptr<const Obstacle> obstacle;
    double friction = 0.0;
  };
  std::vector<With> obstacles;
  bool with_itself = false;
  double friction_with_itself = 0.0;
  /// Vertices outside an obstacle but within this distance (m) of it make contacts, too. These contacts have
  /// a gap; a solver can keep the vertices outside.
  double reach = 0.0;
};

/// The depth of a body in obstacles, and the number of its surface vertices inside the body itself.
struct Penetration {
  double into_obstacles = 0.0;  ///< depth of the deepest surface vertex, m
  Index vertices_in_itself = 0;
};

/// Finds where a body of tetrahedra touches obstacles and itself. The result is the same on every run, for
/// any number of threads, and after any earlier calls.
class ContactFinder {
 public:
  /// Takes the body at rest at `points`. Throws InvalidArgument for simplices that are no tetrahedra, corners
  /// that are not among the points, a negative reach and a missing obstacle.
  ContactFinder(const Simplices& simplices, std::span<const Point> points, ContactOptions options);

  /// Finds the contacts of the surface's vertices at `positions`; the vertices were at `from` when the step
  /// began. Both have kPaddedStride numbers for each vertex (see padded_positions). The contacts are sorted
  /// by first vertex and then obstacle, the body itself last. A vertex inside a tetrahedron of other vertices
  /// is mapped by this tetrahedron to the rest shape; it is in contact with the surface point nearest to its
  /// image.
  void find(std::span<const double> positions, std::span<const double> from, std::vector<Contact>& contacts);

  [[nodiscard]] Penetration penetration(std::span<const double> positions);

  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Vertices of the surface that are searched together.
  struct Cluster {
    std::vector<Index> near;  ///< numbers of the obstacles within reach
    std::vector<Contact> found;
    double deepest = 0.0;
  };

  /// Finds the obstacles within `reach` of each cluster at any of the positions in `places`.
  void find_near(std::initializer_list<std::span<const double>> places, double reach);
  void check(std::span<const double> positions, const char* function) const;

  ContactOptions options_;
  Index vertex_count_;
  std::vector<Index> surface_;  ///< vertices of the surface, in clusters
  std::optional<SelfContact> itself_;
  std::vector<Cluster> clusters_;
  std::vector<Box> boxes_;  ///< around clusters
};

}  // namespace meshorder
