// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/preconditioners/preconditioner.hpp"

#include <memory>

namespace meshorder {

/// Makes a preconditioner for elasticity: one cycle of algebraic multigrid by aggregation, with the
/// rigid-body modes as near-null space (Vaněk, Mandel, Brezina 1996).
///
/// Vertices are gathered in aggregates by the strength of their blocks. Each aggregate is a node of the next
/// level, with its six rigid motions as unknowns. Levels follow until one is solved exactly or hardly
/// coarsens. The prolongation from the first coarse level is plain, so that the first coarse operator stays
/// sparse. The prolongations from coarser levels are smoothed, so that iterations hardly grow with the mesh.
/// Coarse operators are Galerkin products. A cycle makes a forward sweep of block Gauss–Seidel, corrects from
/// the next level (once from the first coarse level and from the last levels, twice from the others: a
/// W-cycle) and makes a backward sweep. Matrices are kept as halves in float; coarse operators are computed
/// in double. Internally the vertices are numbered breadth first, whatever their order in the matrix.
///
/// The first `update` makes the aggregates from the matrix's values; later updates only recompute values, and
/// take a third to a half of the time. A matrix that changes slowly does not need an update each time: with
/// old values the cycle stays symmetric and positive definite, and a solve only takes more iterations. In
/// time stepping, update when iterations have grown by a third since the last update. Vertices without
/// neighbours, such as fixed vertices, stay on the finest level. A vertex may lose its neighbours after the
/// first update.
///
/// The memory is 0.6 to 0.9 times that of the matrix. Set-up, update and cycle each take O(blocks) time, on
/// all threads except for the aggregates. `apply` uses scratch memory of the object and must not be called by
/// two threads at a time. Measured against Jacobi in docs/evidence/benchmarks.md. Throws InvalidArgument
/// unless there are a point and a diagonal block for each row.
std::unique_ptr<Preconditioner> make_multigrid(const BlockCsr& pattern, std::span<const Point> points);

}  // namespace meshorder
