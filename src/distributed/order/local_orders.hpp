// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/curve.hpp"
#include "distributed/order/global_graph.hpp"
#include "distributed/order/partition.hpp"
#include <meshorder/options.hpp>

#include <string_view>
#include <vector>

namespace meshorder::distributed {

/// New numbers of vertices, contiguous by part, and properties of the parts.
struct PartOrders {
  std::vector<GlobalIndex> new_numbers;  ///< new number of the vertex of each row of the graph
  std::vector<GlobalIndex> starts;       ///< first new number of each part, then the end of the last part
  std::vector<GlobalIndex> interfaces;   ///< by part: number of vertices with neighbours in other parts
  GlobalIndex ghosts = 0;                ///< number of neighbours outside each part, summed over the parts
};

/// Orders each part by a method, on the rank of that part. In `spectral`, edges to earlier parts pull
/// vertices to the front, and edges to later parts to the end. The orders of `fiedler`, `minla`, `hilbert`
/// and `morton` are reversed if that brings the two ends of edges between parts nearer to each other. Every
/// rank has to call it. O(entries), plus the cost of the method.
///
/// @param graph     numbered along `curve`; a part's vertices go to the method in that order
/// @param place_of  for each vertex, the position of its part in the order of the parts
/// @param method    name of a vertex method
/// @param interface_place where a part's order has the vertices with neighbours in other parts
/// @throws as `Communicator::exchange`; SharedError if the method throws, or for a part of more than
///         2,147,483,647 vertices
[[nodiscard]] PartOrders ordered_in_parts(const Communicator& communicator, const GlobalGraph& graph,
                                          const Curve& curve, const HaloValues<Index>& place_of, Index parts,
                                          std::string_view method, InterfacePlace interface_place,
                                          const OrderOptions& options);

/// Parts that are ranges of one order of the whole graph.
struct RangesOfOrder {
  PartOrders parts;
  double imbalance = 1;  ///< size of the largest part / mean size
  GlobalIndex cut = 0;   ///< number of edges between parts
};

/// Cuts an order into ranges whose sizes differ by at most one. Every rank has to call it. O(entries).
///
/// @param halo         halo of the graph's ghosts: neighbours that other ranks own
/// @param new_numbers  new number of the vertex of each row of the graph
/// @param parts        ≥ 1
/// @throws as `Communicator::exchange`
[[nodiscard]] RangesOfOrder ranges_of(const Communicator& communicator, const GlobalGraph& graph,
                                      const Halo& halo, std::vector<GlobalIndex> new_numbers, Index parts);

}  // namespace meshorder::distributed
