// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "spectral/aggregation.hpp"

#include <span>

namespace meshorder {

constexpr double kDoubtful = 0.25;  ///< an aggregate hides nothing if eigenvalue · slack is at most this

/// Returns whether an aggregate may hide a vector whose Rayleigh quotient is smaller than `eigenvalue`:
/// coarser graphs then do not show the vector. If false, every such vector is nearly constant on all
/// aggregates: the part that varies within aggregates has at most half of the vector's squared norm.
///
/// An aggregate hides nothing in three cases:
/// - its slack is small, see `aggregate`;
/// - its slack would be small if each joining vertex spread its mass over all its edges to founding members;
/// - the second eigenvalue of L x = μ M x on the aggregate, cut out of the graph, is at least `eigenvalue` /
///   `kDoubtful`, as the signs of pivots show (Sylvester's law of inertia). The pivots of more than 300
///   vertices are not computed: such aggregates may hide a vector.
///
/// O(n + edges + Σ size³) time, summed over the doubtful aggregates; on all threads.
///
/// @param laplacian  columns beyond the rows are ignored
/// @param masses     of the rows; empty: all 1
bool may_hide(const Laplacian& laplacian, const Aggregation& aggregation, std::span<const double> masses,
              double eigenvalue);

/// Returns whether L x = μ M x has more than one eigenvalue below `bound`, counting the 0 of constants.
/// Decides by the signs of pivots; true if a sign is uncertain. O(n³).
///
/// @param masses  of the vertices; empty: all 1
bool has_two_below(const Laplacian& laplacian, std::span<const double> masses, double bound);

}  // namespace meshorder
