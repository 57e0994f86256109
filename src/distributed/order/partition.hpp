// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "distributed/comm/communicator.hpp"
#include "distributed/order/global_graph.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// How a graph is cut into parts.
enum class Partitioner : std::uint8_t {
  ptscotch,  ///< few edges between parts; the same parts for the same graph on the same number of ranks
  hilbert,   ///< ranges of equal weight of the graph's own order; the same parts on any number of ranks
  rsb,       ///< recursive spectral bisection, see `bisected`
  order,     ///< equal ranges of one order of the whole graph, which no part has an order of its own in
};

}  // namespace meshorder::distributed

namespace meshorder {

template <>
struct EnumNames<distributed::Partitioner> {
  static constexpr std::string_view kind = "partition";
  static constexpr std::array names{std::pair{distributed::Partitioner::ptscotch, "ptscotch"},
                                    std::pair{distributed::Partitioner::hilbert, "hilbert"},
                                    std::pair{distributed::Partitioner::rsb, "rsb"},
                                    std::pair{distributed::Partitioner::order, "order"}};
};

}  // namespace meshorder

namespace meshorder::distributed {

/// Parts of a graph.
struct Partition {
  std::vector<Index> part_of;  ///< of each own vertex, 0 … parts − 1
  Partitioner by;              ///< what made them
  std::string reason;          ///< why that is not what was asked for; else empty
};

/// Cuts a graph into parts of about the same weight. `ptscotch` cuts graphs of up to 100,000 vertices by two
/// of its strategies, and keeps the parts with fewer edges between them; it gives way to `hilbert` where it
/// fails or the graph is too small for it. Every rank has to call it.
///
/// @param graph    numbered along Hilbert's curve from 0 on, equal shares on all ranks
/// @param parts    ≥ 1
/// @param by       `ptscotch` or `hilbert`
/// @param weights  > 0, of each own vertex; none: all alike
/// @throws as `Communicator::exchange`
[[nodiscard]] Partition partitioned(const Communicator& communicator, const GlobalGraph& graph, Index parts,
                                    Partitioner by, const std::vector<GlobalIndex>& weights = {});

/// Strategies of PT-Scotch. Which of them leaves fewer edges between parts differs from graph to graph.
enum class ScotchStrategy : std::uint8_t { speed, quality };

/// Cuts a graph by PT-Scotch, with one thread a rank, always alike. Every rank has to call it.
///
/// @param graph     as of `partitioned`
/// @param parts     ≥ 2
/// @param weights   as of `partitioned`
/// @param strategy  `quality` takes up to twice as long as `speed`
/// @param part_of   receives the part of each own vertex
/// @return whether it did; the same on all ranks
/// @throws SharedError where a rank has no memory, and where this program was linked with a PT-Scotch of
///         other than 64-bit numbers
[[nodiscard]] bool cut_by_ptscotch(const Communicator& communicator, const GlobalGraph& graph, Index parts,
                                   const std::vector<GlobalIndex>& weights, ScotchStrategy strategy,
                                   std::vector<Index>& part_of);

}  // namespace meshorder::distributed
