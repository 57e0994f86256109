// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/order.hpp>

#include <dolfinx/graph/AdjacencyList.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// Returns a function that orders graphs in place of DOLFINx's `reorder_gps` or `reorder_rcm`: it takes an
/// `AdjacencyList<std::int32_t>` and returns the new index of each node.
///
/// `create_functionspace` and `create_geometry` take this function as `reorder_fn`; so does `create_mesh` of
/// newer versions. Checked with DOLFINx 0.5.2. The graph has no coordinates, so methods that need them are
/// refused.
///
/// @param method   name of a vertex method
/// @param options  see `OrderOptions`; the arrays that its views refer to must outlive the function
/// @return a function that throws as `order_vertices` does
inline auto dolfinx_reorder(std::string method = "auto", OrderOptions options = {}) {
  return [method = std::move(method),
          options = std::move(options)](const dolfinx::graph::AdjacencyList<std::int32_t>& graph) {
    return order_vertices({graph.offsets(), graph.array()}, method, options).permutation.old_to_new();
  };
}

}  // namespace v0_3
}  // namespace meshorder
