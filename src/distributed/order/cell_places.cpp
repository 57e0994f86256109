// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/cell_places.hpp"

#include "distributed/comm/halo.hpp"
#include <meshorder/shape.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder::distributed {

std::vector<GlobalIndex> places_by_dimension(const Communicator& communicator, const MeshSlice& slice,
                                             const std::vector<GlobalIndex>& in_order) {
  constexpr int kDimensions = 4;
  const int rank = communicator.rank();
  const GlobalIndex first_cell = slice.cells.begin(rank);
  const std::vector<int> own = communicator.together([&] {
    std::vector<int> dimensions;
    for (const Shape shape : slice.shapes) dimensions.push_back(dimension(shape));
    return dimensions;
  });
  const Halo listed(communicator, slice.cells, in_order);
  const std::vector<int> dimensions = listed.fetch(own);
  std::vector<GlobalIndex> places(in_order.size());
  for (int d = 0; d < kDimensions; ++d) {
    const std::vector<GlobalIndex> slots = communicator.together([&] {
      std::vector<GlobalIndex> result;
      for (std::size_t c = 0; c < own.size(); ++c) {
        if (own[c] == d) result.push_back(first_cell + static_cast<GlobalIndex>(c));
      }
      return result;
    });
    const std::vector<std::size_t> cells = communicator.together([&] {
      std::vector<std::size_t> result;
      for (std::size_t k = 0; k < in_order.size(); ++k) {
        if (dimensions[listed.position(in_order[k])] == d) result.push_back(k);
      }
      return result;
    });
    const auto starts = [&](std::size_t size) {
      std::vector<GlobalIndex> result(1, 0);
      for (const GlobalIndex count : communicator.gathered(static_cast<GlobalIndex>(size)))
        result.push_back(result.back() + count);
      return result;
    };
    const GlobalIndex first = starts(cells.size())[static_cast<std::size_t>(rank)];
    const Layout slot_layout(starts(slots.size()));
    std::vector<GlobalIndex> wanted(cells.size());
    std::iota(wanted.begin(), wanted.end(), first);
    const Halo halo(communicator, slot_layout, wanted);
    const std::vector<GlobalIndex> found = halo.fetch(slots);
    for (std::size_t k = 0; k < cells.size(); ++k) places[cells[k]] = found[halo.position(wanted[k])];
  }
  return delivered<GlobalIndex>(communicator, slice.cells, in_order, places, GlobalIndex{-1});
}

std::vector<GlobalIndex> places_by_block(const Communicator& communicator, const Layout& cells,
                                         const std::vector<GlobalIndex>& block_ends,
                                         const std::vector<GlobalIndex>& in_order) {
  const std::size_t blocks = block_ends.size() - 1;
  const auto block_of = [&](GlobalIndex cell) {
    const auto end = std::upper_bound(block_ends.begin() + 1, block_ends.end(), cell);
    return static_cast<std::size_t>(end - block_ends.begin()) - 1;
  };
  const std::vector<GlobalIndex> counts = communicator.together([&] {
    std::vector<GlobalIndex> result(blocks, 0);
    for (const GlobalIndex cell : in_order) ++result[block_of(cell)];
    return result;
  });
  // the first free place of each block for each rank
  std::vector<GlobalIndex> next = communicator.gathered_at_root(counts);
  communicator.at_root([&] {
    std::vector<GlobalIndex> free(block_ends.begin(), block_ends.end() - 1);
    for (std::size_t k = 0; k < next.size(); ++k)
      free[k % blocks] += std::exchange(next[k], free[k % blocks]);
  });
  std::vector<Offset> starts;
  for (int rank = 0; rank <= communicator.size(); ++rank)
    starts.push_back(static_cast<Offset>(blocks) * rank);
  next = communicator.scattered_from_root(next, starts);
  const std::vector<GlobalIndex> places = communicator.together([&] {
    std::vector<GlobalIndex> result;
    result.reserve(in_order.size());
    for (const GlobalIndex cell : in_order) result.push_back(next[block_of(cell)]++);
    return result;
  });
  return delivered<GlobalIndex>(communicator, cells, in_order, places, GlobalIndex{-1});
}

}  // namespace meshorder::distributed
