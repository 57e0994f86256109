// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/permutation.hpp>

namespace meshorder {

/// What part of a vector a sweep over the rows of a matrix reads from memory out of order: of all lines of 8
/// entries, the share whose first touch is a jump. The first touch of a line is no jump if one of the three
/// lines before it was among the last 32 lines touched for the first time. Rows follow the order, entries of
/// a row their columns.
///
/// Where vectors exceed the last cache every line is read from memory once in a sweep; processors fetch ahead
/// those that follow each other. On such meshes this share explains how fast plain products and springs run
/// in different orders, and numbers of cache misses do not.
///
/// `sampled_jump_share` estimates it from windows of 8,192 rows: an eighth of all, of large graphs 8 to 15
/// windows.
///
/// @return 0 for breadth-first orders of meshes, about 1 for random orders; 0 for a graph without vertices
/// @note O(n + edges).
double jump_share(GraphRef graph, const Permutation& order);
double sampled_jump_share(GraphRef graph, const Permutation& order);

}  // namespace meshorder
