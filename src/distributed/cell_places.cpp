// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/cell_places.hpp"

#include "distributed/halo.hpp"
#include <meshorder/shape.hpp>

#include <numeric>

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

}  // namespace meshorder::distributed
