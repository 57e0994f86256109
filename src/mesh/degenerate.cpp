// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/degenerate.hpp"

#include "base/parallel.hpp"

#include <algorithm>

namespace meshorder {

std::vector<Index> degenerate_cells(const Cells& cells) {
  constexpr Index kCellsAtOnce = 65536;
  std::vector<std::vector<Index>> found(chunk_count(cells.size(), kCellsAtOnce));
  for_each_chunk(cells.size(), kCellsAtOnce, [&](Index chunk, Index begin, Index end) {
    std::vector<Index> sorted;
    for (Index c = begin; c < end; ++c) {
      const auto vertices = cells[c];
      sorted.assign(vertices.begin(), vertices.end());
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) found[chunk].push_back(c);
    }
  });
  std::vector<Index> result;
  for (const std::vector<Index>& part : found) result.insert(result.end(), part.begin(), part.end());
  return result;
}

}  // namespace meshorder
