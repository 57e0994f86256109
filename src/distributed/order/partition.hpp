// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/text.hpp"
#include "distributed/comm/communicator.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/order/global_graph.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// Methods of cutting a graph into parts.
enum class Partitioner : std::uint8_t {
  ptscotch,  ///< few edges between parts; the same parts for the same graph on the same number of ranks
  hilbert,   ///< ranges of the graph's numbers with equal weights; same parts on any number of ranks
  rsb,       ///< recursive spectral bisection, see `bisected`
  order,     ///< equal ranges of one order of the whole graph; parts are not ordered separately
};

/// The place of a part's interface in the part's order. The interface is the set of vertices that share an
/// element with vertices of other parts.
enum class InterfacePlace : std::uint8_t {
  mixed,  ///< anywhere, as the method orders them
  last,   ///< after the part's other vertices; both groups keep the method's order
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

template <>
struct EnumNames<distributed::InterfacePlace> {
  static constexpr std::string_view kind = "place of the interface";
  static constexpr std::array names{std::pair{distributed::InterfacePlace::mixed, "mixed"},
                                    std::pair{distributed::InterfacePlace::last, "last"}};
};

}  // namespace meshorder

namespace meshorder::distributed {

/// Parts of a graph.
struct Partition {
  std::vector<Index> part_of;  ///< part of each vertex of this rank, 0 … parts − 1
  Partitioner by;              ///< the partitioner that made the parts
  std::string reason;          ///< why the requested partitioner was not used; empty if it was
};

/// Cuts a graph into parts of about the same weight. `ptscotch` cuts graphs of up to 100,000 vertices with
/// two of its strategies, and keeps the parts with fewer edges between them. If PT-Scotch fails or the
/// graph is too small for it, `hilbert` is used instead. Every rank has to call it.
///
/// @param graph    numbered along a Hilbert curve from 0 on, with equal shares on all ranks
/// @param parts    ≥ 1
/// @param by       `ptscotch` or `hilbert`
/// @param weights  weight > 0 of each vertex of this rank; empty: all 1
/// @throws as `Communicator::exchange`
[[nodiscard]] Partition partitioned(const Communicator& communicator, const GlobalGraph& graph, Index parts,
                                    Partitioner by, const std::vector<GlobalIndex>& weights = {});

/// Strategies of PT-Scotch. Which of them cuts fewer edges depends on the graph.
enum class ScotchStrategy : std::uint8_t { speed, quality };

/// Cuts a graph with PT-Scotch, on one thread per rank; deterministic. Every rank has to call it.
///
/// @param graph     as in `partitioned`
/// @param parts     ≥ 2
/// @param weights   as in `partitioned`
/// @param strategy  `quality` takes up to twice as long as `speed`
/// @param part_of   receives the part of each vertex of this rank
/// @return whether PT-Scotch succeeded; the same on all ranks
/// @throws SharedError if a rank lacks memory, and if this program runs with a PT-Scotch whose numbers do
///         not have 64 bits
[[nodiscard]] bool cut_by_ptscotch(const Communicator& communicator, const GlobalGraph& graph, Index parts,
                                   const std::vector<GlobalIndex>& weights, ScotchStrategy strategy,
                                   std::vector<Index>& part_of);

/// Returns the part of a vertex by its new number. Vertices that no element uses come after the last part;
/// they count as vertices of that part. O(log parts).
///
/// @param starts  first new number of each part, then the end of the last part
[[nodiscard]] inline Index part_of(GlobalIndex vertex, const std::vector<GlobalIndex>& starts) {
  const auto behind = std::upper_bound(starts.begin() + 1, starts.end() - 1, vertex);
  return static_cast<Index>(behind - starts.begin()) - 1;
}

/// Returns the part of a cell: the part of its vertex with the largest new number. Parts of cells in the
/// order `lexmax` thus ascend. A cell has at least one vertex. O(vertices + log parts).
template <class Number>
[[nodiscard]] Index part_of_cell(std::span<const Number> vertices, const std::vector<GlobalIndex>& starts) {
  return part_of(*std::max_element(vertices.begin(), vertices.end()), starts);
}

/// An order of the parts of a graph.
struct Quotient {
  std::vector<Index> place_of;  ///< position of each part in the order
  GlobalIndex cut = 0;          ///< number of edges between parts
};

/// Orders the parts by the Fiedler vector of their quotient graph, whose weights are the numbers of edges
/// between parts. Then moves single parts while that brings strongly joined parts nearer. Every rank has to
/// call it; the root computes the order. O(entries + cut · log cut) time.
///
/// @param part_of  part of each vertex in the graph's rows, 0 … parts − 1
/// @throws as `Communicator::exchange`
[[nodiscard]] Quotient order_of_parts(const Communicator& communicator, const GlobalGraph& graph,
                                      const HaloValues<Index>& part_of, Index parts);

}  // namespace meshorder::distributed
