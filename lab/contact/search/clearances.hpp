// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/branch_motions.hpp"
#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// Distances at rest between vertices and tetrahedra, which show for most vertices in motion that they are
/// still outside.
///
/// A vertex with a clearance c from a tetrahedron has a plane between them, at a distance c from the vertex.
/// An affine map keeps it between them. So where the vertex and the corners are apart from one affine map of
/// their places at rest by distances whose sum is less than c divided by the norm of the inverse map, the
/// vertex is outside.
class Clearances {
 public:
  /// Of clusters at rest from the branches near by.
  Clearances(TetrahedronLeaves& tetrahedra, BranchMotions& motions, std::span<PointCluster> clusters,
             std::span<const Point> rest);

  /// The points of cluster c that may be inside tetrahedra of the branch: all, where nothing is known.
  [[nodiscard]] std::uint64_t in_doubt(Index c, Index branch, const PointCluster& cluster,
                                       const BranchMotions& motions) const;

  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Cluster {
    std::vector<Index> branches;      ///< near by, ascending
    AlignedVector<float> clearances;  ///< kMaxPoints for each of these
    alignas(
        64) std::array<std::array<double, PointCluster::kMaxPoints>, 3> rest{};  ///< x, y, z of each point
  };

  std::vector<Cluster> clusters_;
};

}  // namespace meshorder
