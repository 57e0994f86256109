// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/permutation.hpp>

namespace meshorder {

/// Returns the entries below the diagonal of the Cholesky factor of a matrix with this pattern, whose rows
/// and columns are in the given order: what a sparse direct solver stores, if no entry cancels. They include
/// the entries of the matrix. O(n + entries · α(n)), without the factor's pattern (Gilbert, Ng, Peyton 1994,
/// An efficient algorithm to compute row and column counts for sparse Cholesky factorization).
Offset factor_entries(GraphRef graph, const Permutation& order);

}  // namespace meshorder
