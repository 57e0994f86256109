// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/partition.hpp"

#include <string>
#include <vector>

namespace meshorder::distributed {
namespace {

// PT-Scotch fails, or does not end, where ranks have few vertices; parts of a few vertices are none to cut
// well.
constexpr GlobalIndex kLeastPerRank = 100;
constexpr GlobalIndex kLeastPerPart = 16;

/// Equal ranges of the vertices' numbers.
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

/// Why PT-Scotch is not to be asked; empty if it is.
std::string too_small(const GlobalGraph& graph, Index parts) {
  const GlobalIndex n = graph.layout.size();
  if (n < kLeastPerRank * graph.layout.ranks())
    return "PT-Scotch needs " + std::to_string(kLeastPerRank) + " vertices on each rank";
  if (n < kLeastPerPart * parts)
    return "PT-Scotch needs " + std::to_string(kLeastPerPart) + " vertices in each part";
  return "";
}

}  // namespace

Partition partitioned(const Communicator& communicator, const GlobalGraph& graph, Index parts,
                      Partitioner by) {
  Partition partition;
  partition.by = by;
  if (by == Partitioner::ptscotch && parts > 1) {
    partition.reason = too_small(graph, parts);
    if (partition.reason.empty()) {
      if (cut_by_ptscotch(communicator, graph, parts, partition.part_of)) return partition;
      partition.reason = "PT-Scotch failed";
    }
    partition.by = Partitioner::hilbert;
  }
  partition.part_of = cut_by_numbers(communicator, graph, parts);
  return partition;
}

}  // namespace meshorder::distributed
