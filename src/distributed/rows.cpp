// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/rows.hpp"

#include <algorithm>
#include <cstddef>

namespace meshorder::distributed {

Rows send_rows(const Communicator& communicator, const Rows& rows, std::vector<Dispatch> dispatches) {
  Parcels<Index> sizes;
  Parcels<GlobalIndex> entries;
  communicator.together([&] {
    std::sort(dispatches.begin(), dispatches.end());
    const auto ranks = static_cast<std::size_t>(communicator.size());
    sizes.starts.assign(ranks + 1, 0);
    entries.starts.assign(ranks + 1, 0);
    sizes.values.reserve(dispatches.size());
    for (const Dispatch& dispatch : dispatches) {
      const auto row = rows[dispatch.row];
      sizes.values.push_back(index_size(row));
      entries.values.insert(entries.values.end(), row.begin(), row.end());
      const auto next = static_cast<std::size_t>(dispatch.to) + 1;
      sizes.starts[next] = static_cast<Offset>(sizes.values.size());
      entries.starts[next] = static_cast<Offset>(entries.values.size());
    }
    for (std::size_t r = 1; r <= ranks; ++r) {  // ranks that get nothing
      sizes.starts[r] = std::max(sizes.starts[r], sizes.starts[r - 1]);
      entries.starts[r] = std::max(entries.starts[r], entries.starts[r - 1]);
    }
  });
  const Parcels<Index> sizes_here = communicator.exchange(sizes);
  Rows received;
  received.entries = communicator.exchange(entries).values;
  communicator.together([&] {
    received.offsets.reserve(sizes_here.values.size() + 1);
    for (const Index size : sizes_here.values) received.offsets.push_back(received.offsets.back() + size);
  });
  return received;
}

}  // namespace meshorder::distributed
