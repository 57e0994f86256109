// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/partition.hpp"

#include "distributed/comm/halo.hpp"

#include <algorithm>
#include <numeric>

namespace meshorder::distributed {
namespace {

// PT-Scotch fails, or does not end, if a rank has few vertices. It also cannot cut well if the parts have few
// vertices.
constexpr GlobalIndex kLeastPerRank = 100;
constexpr GlobalIndex kLeastPerPart = 16;
// Graphs of at most this many vertices are cut twice; that takes some tenths of a second.
constexpr GlobalIndex kCutTwice = 100'000;

/// Returns the parts that are equal ranges of the vertices' numbers.
std::vector<Index> cut_by_numbers(const Communicator& communicator, const GlobalGraph& graph, Index parts) {
  return communicator.together([&] {
    const Layout ranges = Layout::even(graph.layout.size(), parts);
    std::vector<Index> part_of;
    part_of.reserve(static_cast<std::size_t>(graph.rows.size()));
    const GlobalIndex end = graph.layout.end(communicator.rank());
    for (GlobalIndex vertex = graph.layout.begin(communicator.rank()); vertex < end; ++vertex)
      part_of.push_back(ranges.owner(vertex));
    return part_of;
  });
}

/// Returns parts that are ranges of the vertices' numbers with about equal weights. The middle of a vertex's
/// weight decides which part the vertex belongs to.
std::vector<Index> cut_by_weights(const Communicator& communicator, const std::vector<GlobalIndex>& weights,
                                  Index parts) {
  const std::vector<GlobalIndex> of_ranks =
      communicator.gathered(std::accumulate(weights.begin(), weights.end(), GlobalIndex{0}));
  const GlobalIndex total = std::accumulate(of_ranks.begin(), of_ranks.end(), GlobalIndex{0});
  GlobalIndex before =
      std::accumulate(of_ranks.begin(), of_ranks.begin() + communicator.rank(), GlobalIndex{0});
  return communicator.together([&] {
    std::vector<Index> part_of;
    part_of.reserve(weights.size());
    for (const GlobalIndex weight : weights) {
      const double middle = static_cast<double>(before) + 0.5 * static_cast<double>(weight);
      const auto part = static_cast<Index>(middle / static_cast<double>(total) * parts);
      part_of.push_back(std::min(part, parts - 1));
      before += weight;
    }
    return part_of;
  });
}

/// Returns why the graph is too small for PT-Scotch; empty if it is large enough.
std::string too_small(const GlobalGraph& graph, Index parts) {
  const GlobalIndex n = graph.layout.size();
  if (n < kLeastPerRank * graph.layout.ranks())
    return "PT-Scotch needs " + std::to_string(kLeastPerRank) + " vertices on each rank";
  if (n < kLeastPerPart * parts)
    return "PT-Scotch needs " + std::to_string(kLeastPerPart) + " vertices in each part";
  return "";
}

/// Returns the number of edges between parts.
GlobalIndex cut_between(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                        const std::vector<Index>& part_of) {
  const HaloValues<Index> parts(halo, graph.layout.begin(communicator.rank()),
                                communicator.together([&] { return part_of; }));
  GlobalIndex entries = 0;
  for (Offset row = 0; row < graph.rows.size(); ++row) {
    const auto neighbours = graph.rows[row];
    entries += std::count_if(neighbours.begin(), neighbours.end(),
                             [&](GlobalIndex neighbour) { return parts[neighbour] != parts.own(row); });
  }
  return communicator.sum(entries) / 2;
}

/// Cuts the graph with PT-Scotch; tries both strategies on small graphs. Returns whether PT-Scotch succeeded.
bool cut_by_best_strategy(const Communicator& communicator, const GlobalGraph& graph, Index parts,
                          const std::vector<GlobalIndex>& weights, std::vector<Index>& part_of) {
  if (!cut_by_ptscotch(communicator, graph, parts, weights, ScotchStrategy::speed, part_of)) return false;
  std::vector<Index> other;
  if (graph.layout.size() > kCutTwice ||
      !cut_by_ptscotch(communicator, graph, parts, weights, ScotchStrategy::quality, other))
    return true;
  const Halo halo(communicator, graph.layout,
                  communicator.together([&] { return ghosts(graph, communicator.rank()); }));
  if (cut_between(communicator, graph, halo, other) < cut_between(communicator, graph, halo, part_of))
    part_of = std::move(other);
  return true;
}

}  // namespace

Partition partitioned(const Communicator& communicator, const GlobalGraph& graph, Index parts, Partitioner by,
                      const std::vector<GlobalIndex>& weights) {
  Partition partition;
  partition.by = by;
  if (by == Partitioner::ptscotch && parts > 1) {
    partition.reason = too_small(graph, parts);
    if (partition.reason.empty()) {
      if (cut_by_best_strategy(communicator, graph, parts, weights, partition.part_of)) return partition;
      partition.reason = "PT-Scotch failed";
    }
    partition.by = Partitioner::hilbert;
  }
  const bool is_weighted = communicator.sum(static_cast<GlobalIndex>(weights.size())) > 0;
  partition.part_of =
      is_weighted ? cut_by_weights(communicator, weights, parts) : cut_by_numbers(communicator, graph, parts);
  return partition;
}

}  // namespace meshorder::distributed
