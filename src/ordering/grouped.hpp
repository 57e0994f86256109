// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"
#include <meshorder/number_view.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace meshorder {

/// Returns the rank, 0 … `count` − 1, of each of `groups` among the distinct numbers. O(size · log size).
///
/// @param what   "vertices" or "cells", for the message
/// @param count  receives the number of groups
/// @throws InvalidArgument unless there are `size` numbers
std::vector<Index> dense_groups(const IndexView& groups, Index size, const char* what, Index& count);

/// Orders the vertices group after group, each group by the method on the graph of its own vertices, so that
/// neighbours within a group stay near each other in memory. `auto` chooses one method for the whole graph.
/// Reports of eigensolvers are in the order of the groups. O(n + edges) and the cost of the method.
///
/// @param group_of  for each vertex the number of its group, 0 … groups − 1
/// @throws as `order_graph`, and InvalidArgument if `group_of` does not fit
Order order_graph_in_groups(std::string_view method, const VertexInput& input,
                            std::span<const Index> group_of, Index groups, const OrderOptions& options = {});

/// Orders vertices by the method, group after group if `options` has groups. Groups may be any integers.
///
/// @throws as `order_graph`, and InvalidArgument unless each vertex has a group or none has
Order order_vertices_by_options(std::string_view method, const VertexInput& input,
                                const OrderOptions& options);

}  // namespace meshorder
