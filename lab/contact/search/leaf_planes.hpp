// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// A point of a cluster, and the tetrahedra of a leaf that may contain it.
struct LeafHit {
  Index point = 0;
  Index leaf = 0;
  std::uint32_t lanes = 0;
};

/// Computes the planes of a leaf at `positions`. The leaf's box must be up to date.
void update_planes(TetrahedronLeaves& tetrahedra, Index leaf, std::span<const double> positions);
/// Lowers the clearances of the task's points; `clearances` has one number for each point of the cluster. A
/// point's clearance is its smallest distance from the leaf's tetrahedra, without those of which it is a
/// corner. The distance from a tetrahedron is the largest signed distance from its planes, negative inside.
void lower_clearances(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
                      std::span<const double> positions, std::span<float> clearances);
/// Appends a hit for each point of the task inside all planes of a tetrahedron of which it is no corner.
void hits_of(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
             std::span<const double> positions, std::vector<LeafHit>& hits);

}  // namespace meshorder
