// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/ranges.hpp"

#include "distributed/order/balance.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace meshorder::distributed {

RangesOfOrder ranges_of(const Communicator& communicator, const GlobalGraph& graph, const Halo& halo,
                        std::vector<GlobalIndex> new_numbers, Index parts) {
  const Layout ranges = Layout::even(graph.layout.size(), parts);
  RangesOfOrder result;
  result.parts.starts = ranges.starts();
  result.parts.new_numbers = std::move(new_numbers);
  std::vector<Index> own = communicator.together([&] {
    std::vector<Index> part_of;
    part_of.reserve(result.parts.new_numbers.size());
    for (const GlobalIndex number : result.parts.new_numbers) part_of.push_back(ranges.owner(number));
    return part_of;
  });
  result.imbalance = imbalance_of(communicator, own, {}, parts);
  const HaloValues<Index> part_of(halo, graph.layout.begin(communicator.rank()), std::move(own));
  communicator.together([&] {
    result.parts.interfaces.assign(static_cast<std::size_t>(parts), 0);
    std::vector<Index> others;
    for (Offset row = 0; row < graph.rows.size(); ++row) {
      const Index part = part_of.own(row);
      others.clear();
      for (const GlobalIndex neighbour : graph.rows[row]) {
        if (part_of[neighbour] != part) others.push_back(part_of[neighbour]);
      }
      if (others.empty()) continue;
      ++result.parts.interfaces[static_cast<std::size_t>(part)];
      result.cut += std::count_if(others.begin(), others.end(), [&](Index other) { return other > part; });
      std::sort(others.begin(), others.end());
      result.parts.ghosts += std::unique(others.begin(), others.end()) - others.begin();
    }
  });
  result.parts.interfaces = communicator.sums(std::move(result.parts.interfaces));
  result.cut = communicator.sum(result.cut);
  result.parts.ghosts = communicator.sum(result.parts.ghosts);
  return result;
}

}  // namespace meshorder::distributed
