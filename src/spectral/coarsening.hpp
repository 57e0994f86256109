// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "spectral/aggregation.hpp"
#include "spectral/sparse_rows.hpp"

#include <vector>

namespace meshorder {

/// The (weighted) Galerkin product Pᵀ L P of the piecewise constant P of an aggregation: the weights between
/// two aggregates added up. O(n + edges), on all threads.
Laplacian collapsed(const Laplacian& fine, const RowChunks& chunks, const Aggregation& aggregation);

/// (I − ω D⁻¹ L) P₀ with P₀ piecewise constant and ω = 2/3 (Vaněk, Mandel, Brezina 1996). Rows sum to 1, as
/// those of P₀ do. O(n + edges).
SparseRows smoothed_prolongation(const Laplacian& fine, const Aggregation& aggregation);

/// Pᵀ L P. O(multiplications).
Laplacian galerkin_product(const Laplacian& fine, const SparseRows& prolongation);

}  // namespace meshorder
