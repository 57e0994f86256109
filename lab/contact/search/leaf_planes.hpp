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

/// Sets the planes of a leaf. Its box must be up to date.
void update_planes(TetrahedronLeaves& tetrahedra, Index leaf, std::span<const double> positions);
/// For each point of the task, lowers its clearance (one for each of the cluster) to the distance by which it
/// is outside some plane of every tetrahedron of which it is no corner; negative inside one.
void lower_clearances(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
                      std::span<const double> positions, std::span<float> clearances);
/// Appends the task's points that no plane of some tetrahedron keeps out; not those that are its corners.
void hits_of(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
             std::span<const double> positions, std::vector<LeafHit>& hits);

}  // namespace meshorder
