// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// A point of a cluster, and the tetrahedra of a leaf that it may be inside of.
struct LeafHit {
  Index point = 0;
  Index leaf = 0;
  std::uint32_t lanes = 0;
};

/// The planes of a leaf whose box is up to date.
void update_planes(TetrahedronLeaves& tetrahedra, Index leaf, std::span<const double> positions);
/// Of the task's points, lowers `clearances` (one for each of the cluster) to the distance that each is
/// beyond some plane of every tetrahedron that it is no corner of; negative where it is inside one.
void lower_clearances(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
                      std::span<const double> positions, std::span<float> clearances);
/// Appends the points of a task that no plane of some tetrahedron keeps out, which they are no corners of.
void hits_of(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
             std::span<const double> positions, std::vector<LeafHit>& hits);

}  // namespace meshorder
