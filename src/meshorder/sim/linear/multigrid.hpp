// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/sim/linear/preconditioner.hpp>

#include <memory>

namespace meshorder {

/// One cycle of algebraic multigrid by aggregation with the rigid-body modes as near-null space (Vaněk,
/// Mandel, Brezina 1996), for elasticity.
///
/// Vertices are gathered in aggregates by the strength of their blocks; each aggregate is a node of the next
/// level with six unknowns, its rigid motions, and so on to a level that is solved exactly. The prolongation
/// from the first coarse level is plain, so that the finest operator keeps its sparsity, those below are
/// smoothed; coarse operators are Galerkin products. A cycle sweeps Gauss–Seidel over the blocks forwards,
/// then corrects from the next level, there once on the first coarse level and twice below (a W-cycle), and
/// sweeps backwards. The levels' matrices are kept as halves in float; coarse operators are computed in
/// double.
///
/// The aggregates are made in the first `update`, from its numbers; those after it only recompute numbers. A
/// matrix that changes slowly need not be taken over each time: the cycle stays symmetric and positive
/// definite with old numbers, and only iterations are lost. Vertices without neighbours, as fixed ones are,
/// stay on the finest level.
///
/// Memory: about two thirds of the matrix. O(blocks) for set-up, update and cycle, on all threads but for the
/// aggregates.
/// `apply` uses room of its own, so that one preconditioner serves one thread at a time.
std::unique_ptr<Preconditioner> make_multigrid(const BlockCsr& pattern, std::span<const Point> points);

}  // namespace meshorder
