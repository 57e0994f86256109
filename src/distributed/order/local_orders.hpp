// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/curve.hpp"
#include "distributed/order/global_graph.hpp"
#include "distributed/order/interface_place.hpp"
#include <meshorder/options.hpp>

#include <string_view>
#include <vector>

namespace meshorder::distributed {

/// New numbers of vertices, contiguous by part, and what is reported of the parts.
struct PartOrders {
  std::vector<GlobalIndex> new_numbers;  ///< of the vertices in the graph's rows
  std::vector<GlobalIndex> starts;       ///< first new number of each part, and the end of the last one's
  std::vector<GlobalIndex> interfaces;   ///< of each part: vertices with neighbours in other parts
  GlobalIndex ghosts = 0;                ///< vertices that parts need of others, summed over the parts
};

/// Orders each part by a method, on the rank that the part falls to. `spectral` gets the pull of the parts
/// before and after; what other methods make is turned round where that brings the ends of edges between
/// parts nearer. Every rank has to call it. O(entries) and what the method costs.
///
/// @param graph     numbered as `curve` says, and ordered within a part from there
/// @param place_of  part of each vertex, numbered by the order of the parts
/// @param method    name of a vertex method
/// @param interface_place where a part has the vertices with neighbours in other parts
/// @throws as `Communicator::exchange`; SharedError with what the method throws
[[nodiscard]] PartOrders ordered_in_parts(const Communicator& communicator, const GlobalGraph& graph,
                                          const Curve& curve, const HaloValues<Index>& place_of, Index parts,
                                          std::string_view method, InterfacePlace interface_place,
                                          const OrderOptions& options);

}  // namespace meshorder::distributed
