// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/branch_motions.hpp"
#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// Distances at rest between vertices and tetrahedra. They prove for most moving vertices that the vertex is
/// still outside.
///
/// If a vertex has the clearance c from a tetrahedron, a plane at the distance c from the vertex separates
/// the two. The image of the plane under an affine map separates their images. So the vertex is outside if d
/// + e < c / ‖inverse map‖, where d is the distance of the vertex from its image, and e the largest distance
/// of a corner from its image.
class Clearances {
 public:
  /// Computes the clearances of clusters at rest from the branches near them.
  Clearances(TetrahedronLeaves& tetrahedra, BranchMotions& motions, std::span<PointCluster> clusters,
             std::span<const Point> rest);

  /// Returns the points of cluster c that may be inside tetrahedra of the branch; all points if no clearances
  /// from the branch are known.
  [[nodiscard]] std::uint64_t in_doubt(Index c, Index branch, const PointCluster& cluster,
                                       const BranchMotions& motions) const;

  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Cluster {
    std::vector<Index> branches;      ///< near the cluster, ascending
    AlignedVector<float> clearances;  ///< kMaxPoints for each of these branches
    alignas(
        64) std::array<std::array<double, PointCluster::kMaxPoints>, 3> rest{};  ///< x, y, z of each point
  };

  std::vector<Cluster> clusters_;
};

}  // namespace meshorder
