// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/rows.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>

namespace meshorder::distributed {

Rows send_rows(const Communicator& communicator, Rows rows, std::vector<Dispatch> dispatches) {
  Parcels<Index> sizes;
  Parcels<GlobalIndex> entries;
  communicator.together([&] {
    // first the counts for each rank, then their partial sums
    const auto ranks = static_cast<std::size_t>(communicator.size());
    sizes.starts.assign(ranks + 1, 0);
    entries.starts.assign(ranks + 1, 0);
    for (const Dispatch& dispatch : dispatches) {
      const auto to = static_cast<std::size_t>(dispatch.to) + 1;
      ++sizes.starts[to];
      entries.starts[to] += std::ssize(rows[dispatch.row]);
    }
    std::partial_sum(sizes.starts.begin(), sizes.starts.end(), sizes.starts.begin());
    std::partial_sum(entries.starts.begin(), entries.starts.end(), entries.starts.begin());
    sizes.values.resize(dispatches.size());
    entries.values.resize(static_cast<std::size_t>(entries.starts.back()));
    std::vector<Offset> next_size(sizes.starts.begin(), sizes.starts.end() - 1);
    std::vector<Offset> next_entry(entries.starts.begin(), entries.starts.end() - 1);
    for (const Dispatch& dispatch : dispatches) {
      const auto row = rows[dispatch.row];
      const auto to = static_cast<std::size_t>(dispatch.to);
      sizes.values[static_cast<std::size_t>(next_size[to]++)] = index_size(row);
      std::copy(row.begin(), row.end(), entries.values.begin() + next_entry[to]);
      next_entry[to] += std::ssize(row);
    }
    rows = {};
    dispatches = {};
  });
  const Parcels<Index> sizes_here = communicator.exchange(sizes);
  sizes = {};
  Rows received;
  received.entries = communicator.exchange(entries).values;
  entries = {};
  communicator.together([&] {
    received.offsets.reserve(sizes_here.values.size() + 1);
    for (const Index size : sizes_here.values) received.offsets.push_back(received.offsets.back() + size);
  });
  return received;
}

}  // namespace meshorder::distributed
