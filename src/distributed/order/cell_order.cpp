// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/cell_order.hpp"

#include "distributed/comm/number_set.hpp"
#include "graph/incidence.hpp"
#include "ordering/method.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace meshorder::distributed {
namespace {

/// Returns the cells as rows to be sent: the cell's number, followed by its vertices.
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

/// Returns the vertices of the cells in such rows.
NumberSet vertices_in(const Rows& rows) {
  std::vector<GlobalIndex> vertices;
  vertices.reserve(rows.entries.size());
  for (Offset c = 0; c < rows.size(); ++c)
    vertices.insert(vertices.end(), rows[c].begin() + 1, rows[c].end());
  return NumberSet(vertices);
}

/// Returns the numbers of the cells in such rows, sorted by `lexmax`. The cells' numbers must ascend.
/// Vertices are renumbered 0, 1, … within these rows, which keeps their sequence.
std::vector<GlobalIndex> sorted_by_lexmax(Rows rows) {
  Incidence cells;
  std::vector<GlobalIndex> numbers;
  {
    const NumberSet vertices = vertices_in(rows);
    if (std::max<Offset>(rows.size(), std::ssize(vertices.numbers())) > kMaxIndex) {
      throw TooLarge("more than 2,147,483,647 cells on a rank; start more ranks");
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

}  // namespace meshorder::distributed
