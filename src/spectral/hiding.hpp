// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "spectral/aggregation.hpp"

#include <span>

namespace meshorder {

constexpr double kDoubtful = 0.25;  ///< share of an eigenvector's norm² that may vary within aggregates

/// Whether an aggregate may hide a vector of a smaller Rayleigh quotient than `eigenvalue`, so that coarser
/// graphs do not show it. Where it answers no, such vectors are constant on all aggregates but for half of
/// their squared norm at most.
///
/// Aggregates of little slack hide nothing, see `aggregate`. Nor do those whose slack is little when the
/// vertices that joined spread over all edges to founding members, or whose second eigenvalue of L x = μ M x,
/// cut out of the graph, is at least `eigenvalue` / `kDoubtful`, as the signs of pivots say (Sylvester's law
/// of inertia). The pivots of more than 300 vertices are not looked at: such aggregates may hide a vector.
/// O(n + edges) and the cube of the vertices of doubtful aggregates; on all threads.
///
/// @param laplacian  columns that are no rows belong to no aggregate
/// @param masses     of the rows; none: all 1
bool may_hide(const Laplacian& laplacian, const Aggregation& aggregation, std::span<const double> masses,
              double eigenvalue);

/// Whether L x = μ M x has more than one eigenvalue below `bound`; constants have the first one, 0. Pivots
/// say it; true also where they do not. O(n³).
///
/// @param masses  as above
bool has_two_below(const Laplacian& laplacian, std::span<const double> masses, double bound);

}  // namespace meshorder
