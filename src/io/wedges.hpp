// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <span>
#include <vector>

namespace meshorder {

/// Returns the signed volume of the parallelepiped spanned by three edges at a cell's first corner. Its sign
/// is that of the cell's volume if the cell is convex. Returns 0 for cells other than linear tetrahedra,
/// pyramids, wedges and hexahedra. O(1).
double volume_at_first_corner(const std::vector<Point>& points, Shape shape, std::span<const Index> cell);

/// Finds out from volumes how a file numbers its linear wedges.
///
/// The first triangle of a wedge faces outward in the files of some programs and inward in those of others,
/// and the files do not say which. Faces, normals and volumes depend on that; shape functions do not.
class WedgeVote {
 public:
  /// `points`: the vertices of the cells; they must outlive this object.
  explicit WedgeVote(const std::vector<Point>& points) : points_(points) {}

  /// Adds a cell, whose vertices are in the order of the file. Ignores all cells but linear tetrahedra,
  /// hexahedra, pyramids and wedges. O(1).
  void add(Shape shape, std::span<const Index> cell);

  /// Returns whether the first triangles of wedges face inward: whether the wedges' volumes, computed on this
  /// assumption, have the sign of the other cells' volumes (positive if there are no other cells). A sign
  /// needs more than 20 of 21 nonzero volumes; returns false if signs are mixed.
  [[nodiscard]] bool wedges_face_inward() const;

  /// Returns 1 or −1 if more than 20 of 21 nonzero volumes have that sign, else 0. Wedges count as if their
  /// first triangles faced inward.
  [[nodiscard]] int sign_of_volumes() const;

 private:
  /// Numbers of cells by the sign of their volumes.
  struct Volumes {
    Offset positive = 0;
    Offset negative = 0;

    /// Returns 1 or −1 if more than 20 of 21 volumes have that sign, else 0.
    [[nodiscard]] int sign() const;
  };

  const std::vector<Point>& points_;
  Volumes wedges_;
  Volumes others_;
};

}  // namespace meshorder
