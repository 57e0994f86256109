// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"
#include "kernels/aligned.hpp"
#include "kernels/simplices.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace meshorder {

/// Number of tetrahedra, or boxes, that are tested at a time: an AVX-512 register has as many floats.
inline constexpr Index kLeaf = 16;
/// Number of leaves in a branch, at most kLeaf: fewer leaves make a branch's motion closer to affine, but
/// make more branches.
inline constexpr Index kBranch = 8;

/// Returns the nearest float; the largest finite one on overflow.
inline float rounded_to_float(double a) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(a, -kLargest, kLargest));
}

/// Points that are searched together: at most 64 neighbours, one bit of a mask each.
struct PointCluster {
  static constexpr Index kMaxPoints = 64;

  std::uint64_t points = 0;                  ///< the bits of all points
  std::array<Index, kMaxPoints> vertices{};  ///< the last vertex repeats up to the end
  alignas(64) std::array<std::array<double, kMaxPoints>, 3> positions{};   ///< x, y, z of each
  alignas(64) std::array<std::array<float, kMaxPoints>, 3> coordinates{};  ///< the same, rounded
  std::array<float, 3> lower{}, upper{};  ///< box of the points; upper < lower if all are NaN

  /// Makes a cluster of 1 … kMaxPoints vertices.
  explicit PointCluster(std::span<const Index> some);
};

/// Tetrahedra in leaves (sixteen that are neighbours at rest) and branches (kBranch leaves): the data that a
/// search needs in motion. Ends of boxes and points are rounded alike, which keeps their order. Vertices and
/// tetrahedra that are not finite are never found.
struct TetrahedronLeaves {
  Index leaves = 0;
  Index branches = 0;
  /// Entry 16 · (4i + k) + l: corner k in lane l of leaf i. Lanes after the last tetrahedron repeat it.
  AlignedVector<Index> corners;
  AlignedVector<Index> numbers;  ///< the caller's numbers of the tetrahedra; −1 after the last
  /// Entry 16 · (6b + e) + l: end e of the box of leaf l in branch b; three lower ends, then the upper ends.
  AlignedVector<float> leaf_boxes;
  AlignedVector<float> branch_boxes;           ///< boxes of the branches, in the same layout
  std::vector<std::array<double, 3>> centers;  ///< of leaves; the planes of a leaf are relative to its center
  /// Planes of the faces, by update_planes. Entry 16 · (16i + 4k + q) + l: number q of face k in lane l of
  /// leaf i. The four numbers are the inward normal and the offset, raised by a bound of rounding errors.
  AlignedVector<float> planes;

  /// Takes tetrahedra in the order of leaves. Does not set boxes and planes.
  TetrahedronLeaves(std::span<const std::array<Index, 4>> tetrahedra,
                    std::span<const Index> tetrahedron_numbers);

  [[nodiscard]] Index leaves_of(Index branch) const { return std::min(kBranch, leaves - kBranch * branch); }
  /// Returns the ends of a leaf's or a branch's box, each kLeaf floats after the previous one.
  [[nodiscard]] const float* leaf_box(Index leaf) const {
    return leaf_boxes.data() + Offset{6} * kLeaf * (leaf / kBranch) + leaf % kBranch;
  }
  [[nodiscard]] const float* branch_box(Index branch) const {
    return branch_boxes.data() + Offset{6} * kLeaf * (branch / kLeaf) + branch % kLeaf;
  }
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;
};

/// A leaf, and points of a cluster that are to be tested against it.
struct LeafTask {
  Index leaf = 0;
  std::uint64_t points = 0;
};

/// Sets the boxes of the branch's leaves at `positions`. O(tetrahedra of the branch).
void update_boxes(TetrahedronLeaves& tetrahedra, Index branch, std::span<const double> positions);
/// Sets the positions and the box of the cluster's points.
void update_points(PointCluster& cluster, std::span<const double> positions);
/// Sets `branches` to those whose box meets the cluster's box, ascending.
void branches_at(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster,
                 std::vector<Index>& branches);
/// Appends a task for each of the branch's leaves whose box contains points of the cluster that are in the
/// mask `points`.
void leaves_at(const TetrahedronLeaves& tetrahedra, Index branch, const PointCluster& cluster,
               std::uint64_t points, std::vector<LeafTask>& tasks);

}  // namespace meshorder
