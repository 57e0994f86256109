// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"

#include <span>
#include <string_view>

namespace meshorder {

/// Orders the vertices group after group, each group by the method on the graph of its own vertices, so that
/// neighbours within a group stay neighbours in memory. `group_of` gives each vertex the number of its group,
/// 0 … `groups` − 1. Vertices without neighbours in their group come last in it. `auto` chooses once, for the
/// whole graph; reports of eigensolvers follow each other as the groups do. Throws InvalidArgument like
/// `order_vertices`, and when `group_of` does not fit. O(n + edges) and what the method costs.
Ordering order_vertices_in_groups(std::string_view method, const VertexProblem& problem,
                                  std::span<const Index> group_of, Index groups,
                                  const OrderingOptions& options = {});

}  // namespace meshorder
