// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "lab/linear/multigrid/block_rows.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Vertices or nodes by aggregate: the members of aggregate a are `members[starts[a]] … members[starts[a + 1]
/// − 1]`, ascending.
struct Aggregates {
  std::vector<Index> starts{0};
  std::vector<Index> members;

  [[nodiscard]] Index count() const noexcept { return index_size(starts) - 1; }
};

/// Returns the displacements of each point in the six infinitesimal rigid motions about the mean point: 3×6
/// numbers a point, row by row. Columns are translations along x, y, z, then rotations about these axes.
/// O(points).
std::vector<double> rigid_modes(std::span<const Point> points);

/// Result of aggregation: the prolongation and the modes of the coarse nodes.
template <int R>
struct RigidProlongation {
  Prolongation<R> prolongation;
  /// 6×6 numbers a coarse node: the unknowns from which prolongation reproduces each mode.
  std::vector<double> coarse_modes;
};

/// Returns the prolongation in which a fine node depends only on its own aggregate. The columns of an
/// aggregate are the modes, restricted to the aggregate and orthonormalised (Vaněk, Mandel, Brezina 1996). A
/// mode that depends on earlier modes of the aggregate (rotations of a single vertex, the rotation of a line
/// about itself) gets a column of zeros. `modes` holds R×6 numbers for each of `fine_count` nodes; nodes in
/// no aggregate get empty rows. O(fine nodes).
template <int R>
RigidProlongation<R> rigid_prolongation(const Aggregates& aggregates, Index fine_count,
                                        std::span<const double> modes);

}  // namespace meshorder
