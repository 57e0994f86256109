// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/permutation.hpp>
#include <meshorder/quality.hpp>

namespace meshorder {

/// Computes the public `sparsity_pattern` of a clean graph. O(n + edges).
SparsityPattern pattern_of(GraphRef graph, const Permutation& order, int side);

}  // namespace meshorder
