// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/cell_order.hpp"

#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_set.hpp"
#include "graph/incidence.hpp"
#include "ordering/method.hpp"
#include <meshorder/error.hpp>
#include <meshorder/shape.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace meshorder::distributed {
namespace {

/// Returns the cells as rows to be sent: each cell's number, followed by its vertices.
Rows with_numbers(const Rows& cell_vertices, GlobalIndex first) {
  Rows rows;
  rows.entries.reserve(cell_vertices.entries.size() + cell_vertices.offsets.size());
  rows.offsets.reserve(cell_vertices.offsets.size());
  for (Offset c = 0; c < cell_vertices.size(); ++c) {
    rows.entries.push_back(first + c);
    rows.entries.insert(rows.entries.end(), cell_vertices[c].begin(), cell_vertices[c].end());
    rows.end_row();
  }
  return rows;
}

/// Returns the vertices of the cells in rows made by `with_numbers`.
NumberSet vertices_in(const Rows& rows) {
  std::vector<GlobalIndex> vertices;
  vertices.reserve(rows.entries.size());
  for (Offset c = 0; c < rows.size(); ++c)
    vertices.insert(vertices.end(), rows[c].begin() + 1, rows[c].end());
  return NumberSet(vertices);
}

/// Returns the numbers of the cells, sorted by `lexmax`. `rows` come from `with_numbers`; cell numbers
/// ascend. For the sort, the vertices are renumbered 0, 1, … in the same sequence.
std::vector<GlobalIndex> sorted_by_lexmax(Rows rows) {
  Incidence cells;
  std::vector<GlobalIndex> numbers;
  {
    const NumberSet vertices = vertices_in(rows);
    if (std::max<Offset>(rows.size(), std::ssize(vertices.numbers())) > kMaxIndex) {
      throw TooLarge("more than 2,147,483,647 cells or vertices on a rank; start more ranks");
    }
    cells.vertex_count = index_size(vertices.numbers());
    cells.vertices.reserve(rows.entries.size());
    cells.offsets.reserve(rows.offsets.size());
    numbers.reserve(rows.offsets.size());
    for (Offset c = 0; c < rows.size(); ++c) {
      numbers.push_back(rows[c].front());
      for (const GlobalIndex vertex : rows[c].subspan(1))
        cells.vertices.push_back(static_cast<Index>(vertices.position(vertex)));
      cells.offsets.push_back(static_cast<Offset>(cells.vertices.size()));
    }
    rows = {};
  }
  const Permutation as_numbered = Permutation::identity(cells.vertex_count);
  const Order order = order_incidence("lexmax", {cells, as_numbered, {}, {}});
  std::vector<GlobalIndex> result;
  result.reserve(numbers.size());
  for (const Index c : order.permutation.new_to_old()) result.push_back(numbers[c]);
  return result;
}

}  // namespace

std::vector<GlobalIndex> cells_by_lexmax(const Communicator& communicator, const Layout& cells,
                                         Rows cell_vertices, const Layout& vertices) {
  Rows received;
  {
    std::vector<Dispatch> dispatches;
    Rows rows = communicator.together([&] {
      dispatches.reserve(cell_vertices.offsets.size());
      for (Offset c = 0; c < cell_vertices.size(); ++c) {
        const auto own = cell_vertices[c];
        dispatches.push_back({vertices.owner(*std::max_element(own.begin(), own.end())), c});
      }
      return with_numbers(cell_vertices, cells.begin(communicator.rank()));
    });
    cell_vertices = {};
    received = send_rows(communicator, std::move(rows), std::move(dispatches));
  }
  return communicator.together([&] { return sorted_by_lexmax(std::move(received)); });
}

std::vector<GlobalIndex> own_cells_by_lexmax(const Rows& cell_vertices) {
  return sorted_by_lexmax(with_numbers(cell_vertices, 0));
}

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
    const auto layout_of = [&](const auto& own_ones) {
      return Layout::of_sizes(communicator.gathered(std::ssize(own_ones)));
    };
    const GlobalIndex first = layout_of(cells).begin(rank);
    const Layout slot_layout = layout_of(slots);
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
  // for each rank and block: the first place that the rank fills in the block
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
