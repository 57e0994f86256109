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
/// point's clearance is a lower bound of its distance from the leaf's tetrahedra of which it is no corner:
/// the smallest, over these, of the largest signed distance out of a plane, by normals no longer than 1.
void lower_clearances(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
                      std::span<const double> positions, std::span<float> clearances);
/// Appends a hit for each point of the task that is inside all planes of a tetrahedron and is none of its
/// corners.
void hits_of(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
             std::span<const double> positions, std::vector<LeafHit>& hits);

}  // namespace meshorder
