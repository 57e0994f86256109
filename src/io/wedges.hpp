// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <span>
#include <vector>

namespace meshorder {

/// Returns the volume that three edges of a cell span at its first corner, which has the sign of the volume
/// of the cell where it is convex; 0 for other cells than linear tetrahedra, pyramids, wedges and hexahedra.
/// O(1).
double volume_at_first_corner(const std::vector<Point>& points, Shape shape, std::span<const Index> cell);

/// Finds out from volumes how a file numbers its linear wedges.
///
/// The first triangle of a wedge faces outward in the files of some programs and inward in those of others,
/// and the files do not say which. Shape functions do not mind; faces, normals and volumes do.
class WedgeVote {
 public:
  /// Of cells with these vertices, which must outlive this object.
  explicit WedgeVote(const std::vector<Point>& points) : points_(points) {}

  /// Counts a cell in the order of the file. Only linear tetrahedra, hexahedra, pyramids and wedges have a
  /// say. O(1).
  void add(Shape shape, std::span<const Index> cell);

  /// Returns whether the first triangles of wedges face inward: whether more than 20 of 21 wedges then have
  /// volumes of the sign of the other cells, or positive ones where there are no others. False if signs
  /// are mixed.
  [[nodiscard]] bool wedges_face_inward() const;

  /// Returns 1 or −1 where more than 20 of 21 cells, wedges with their first triangle inward, have volumes of
  /// that sign, else 0.
  [[nodiscard]] int sign_of_volumes() const;

 private:
  /// Cells by the sign of their volumes.
  struct Volumes {
    Offset positive = 0;
    Offset negative = 0;

    /// 1 or −1 where more than 20 of 21 have that sign, else 0.
    [[nodiscard]] int sign() const;
  };

  const std::vector<Point>& points_;
  Volumes wedges_;
  Volumes others_;
};

}  // namespace meshorder
