// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/mesh_parts.hpp"

#include "base/index.hpp"
#include "distributed/comm/rows.hpp"
#include "distributed/files/piece_contents.hpp"
#include "distributed/order/partition.hpp"
#include "mesh/values.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder::distributed {
namespace {

/// Returns the items of each part, ascending. `for_parts(item, take)` calls `take(part)` for each part that
/// has the item.
template <class ForParts>
Incidence items_of_parts(Index parts, Index items, const ForParts& for_parts) {
  Incidence result;
  result.vertex_count = items;
  result.offsets.assign(static_cast<std::size_t>(parts) + 1, 0);
  for (Index item = 0; item < items; ++item)
    for_parts(item, [&](Index part) { ++result.offsets[static_cast<std::size_t>(part) + 1]; });
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.vertices.resize(static_cast<std::size_t>(result.offsets.back()));
  std::vector<Offset> next(result.offsets.begin(), result.offsets.end() - 1);
  for (Index item = 0; item < items; ++item) {
    for_parts(item, [&](Index part) { result.vertices[next[part]++] = item; });
  }
  return result;
}

/// Returns the position of each part's first vertex among the vertices that a rank has, then the end of the
/// last part.
std::vector<GlobalIndex> local_starts(const std::vector<GlobalIndex>& vertices,
                                      const std::vector<GlobalIndex>& part_starts) {
  std::vector<GlobalIndex> result;
  result.reserve(part_starts.size());
  for (const GlobalIndex start : part_starts)
    result.push_back(std::lower_bound(vertices.begin(), vertices.end(), start) - vertices.begin());
  return result;
}

/// Returns the vertices of each part, ascending.
Incidence vertices_of_parts(const Mesh& mesh, const Incidence& cells,
                            const std::vector<GlobalIndex>& part_starts) {
  const auto count = static_cast<std::size_t>(mesh.vertex_count());
  std::vector<Index> last(count, -1);  // the last part in which each vertex was found
  std::vector<std::vector<Index>> found(static_cast<std::size_t>(cells.size()));
  for (Index part = 0; part < cells.size(); ++part) {
    for (const Index cell : cells[part]) {
      for (const Index vertex : mesh.cells[cell]) {
        if (std::exchange(last[vertex], part) != part) found[part].push_back(vertex);
      }
    }
  }
  for (Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    if (last[vertex] < 0) found[part_of(vertex, part_starts)].push_back(vertex);
  }
  Incidence result;
  result.vertex_count = mesh.vertex_count();
  for (std::vector<Index>& vertices : found) {
    std::sort(vertices.begin(), vertices.end());
    result.vertices.insert(result.vertices.end(), vertices.begin(), vertices.end());
    result.offsets.push_back(static_cast<Offset>(result.vertices.size()));
    vertices = {};
  }
  return result;
}

}  // namespace

MeshParts::MeshParts(const Communicator& communicator, const Mesh& mesh, const ShareNumbers& numbers,
                     const std::vector<GlobalIndex>& part_starts) {
  communicator.together([&] { find_own(mesh, local_starts(numbers.vertices, part_starts)); });
  find_sharing_parts(communicator, numbers);
}

void MeshParts::find_own(const Mesh& mesh, const std::vector<GlobalIndex>& part_starts) {
  const auto parts = static_cast<Index>(part_starts.size()) - 1;
  part_of_cells_.reserve(static_cast<std::size_t>(mesh.cell_count()));
  for (Index c = 0; c < mesh.cell_count(); ++c)
    part_of_cells_.push_back(part_of_cell(mesh.cells[c], part_starts));
  cells_ =
      items_of_parts(parts, mesh.cell_count(), [&](Index cell, const auto& take) { take(part_with(cell)); });
  vertices_ = vertices_of_parts(mesh, cells_, part_starts);
  parts_of_vertices_ = transposed(vertices_);
  for (Index part = 0; part < parts; ++part) {
    // move the part's own vertices, whose numbers form a range, to the front
    const auto begin = vertices_.vertices.begin() + vertices_.offsets[part];
    const auto end = vertices_.vertices.begin() + vertices_.offsets[static_cast<std::size_t>(part) + 1];
    const auto is_own = [&](Index vertex) { return part_of(vertex, part_starts) == part; };
    const auto own = std::find_if(begin, end, is_own);
    std::rotate(begin, own, std::find_if_not(own, end, is_own));
  }
}

/// Adds the parts of other ranks to `parts_of_vertices_`. Every rank sends each of its vertices, with the
/// parts that have the vertex, to the owner of the vertex. If several parts have a vertex, the owner sends
/// their list to the ranks of these parts.
void MeshParts::find_sharing_parts(const Communicator& communicator, const ShareNumbers& numbers) {
  if (communicator.size() == 1) return;
  struct Letter {
    GlobalIndex vertex;
    Index part;
  };
  const std::vector<Letter> letters = communicator.together([&] {
    std::vector<Letter> result;
    for (Index v = 0; v < index_size(numbers.vertices); ++v) {
      for (const Index part : parts_with(v)) result.push_back({numbers.vertices[v], part});
    }
    return result;
  });
  std::vector<Letter> asked = sent_to_ranks(
      communicator, letters, [&](const Letter& letter) { return numbers.layout.owner(letter.vertex); });
  Rows shared;  // each row is a vertex followed by its parts
  std::vector<Dispatch> dispatches;
  communicator.together([&] {
    std::sort(asked.begin(), asked.end(), [](const Letter& a, const Letter& b) {
      return std::pair(a.vertex, a.part) < std::pair(b.vertex, b.part);
    });
    const Layout ranks = ranks_of_parts(size(), communicator.size());
    for (auto begin = asked.begin(), end = begin; begin != asked.end(); begin = end) {
      end = std::find_if(begin, asked.end(), [&](const Letter& one) { return one.vertex != begin->vertex; });
      if (end - begin == 1) continue;
      shared.entries.push_back(begin->vertex);
      int last_rank = -1;
      for (auto one = begin; one != end; ++one) {
        shared.entries.push_back(one->part);
        const int rank = ranks.owner(one->part);
        if (rank != last_rank) dispatches.push_back({rank, shared.size()});
        last_rank = rank;
      }
      shared.end_row();
    }
  });
  const Rows received = send_rows(communicator, std::move(shared), std::move(dispatches));
  communicator.together([&] {
    // the first entries of the rows, which are the vertices, ascend
    Incidence all;
    all.vertex_count = parts_of_vertices_.vertex_count;
    Offset row = 0;
    for (Index v = 0; v < index_size(numbers.vertices); ++v) {
      if (row < received.size() && received[row].front() == numbers.vertices[v]) {
        for (const GlobalIndex part : received[row++].subspan(1))
          all.vertices.push_back(static_cast<Index>(part));
      } else {
        const auto own = parts_with(v);
        all.vertices.insert(all.vertices.end(), own.begin(), own.end());
      }
      all.offsets.push_back(static_cast<Offset>(all.vertices.size()));
    }
    parts_of_vertices_ = std::move(all);
  });
}

PartCutter::PartCutter(const Mesh& mesh, const MeshParts& parts)
    : mesh_(mesh),
      parts_(parts),
      vertex_places_(static_cast<std::size_t>(mesh.vertex_count()), 0),
      cell_places_(static_cast<std::size_t>(mesh.cell_count()), 0) {
  const auto shared_out = [&](Association association, const std::vector<Index>& numbers) {
    return items_of_parts(parts.size(), index_size(numbers), [&](Index row, const auto& take) {
      const Index number = numbers[row];
      if (association == Association::cells) return take(parts.part_with(number));
      for (const Index part : parts.parts_with(number)) take(part);
    });
  };
  for (const DataArray& array : mesh.data)
    rows_.push_back(array.is_dense() ? Incidence{} : shared_out(array.association, array.indices));
  for (const EntitySet& set : mesh.sets) members_.push_back(shared_out(set.association, set.members));
}

Mesh PartCutter::cut(Index part) {
  Mesh piece;
  piece.dimension = mesh_.dimension;
  piece.format = mesh_.format;
  piece.format_metadata = mesh_.format_metadata;
  const auto place_all = [](std::span<const Index> numbers, std::vector<Index>& places) {
    for (std::size_t k = 0; k < numbers.size(); ++k) places[numbers[k]] = static_cast<Index>(k);
  };
  place_all(parts_.vertices(part), vertex_places_);
  place_all(parts_.cells(part), cell_places_);
  for (const Index vertex : parts_.vertices(part)) {
    piece.points.push_back(mesh_.points[vertex]);
    if (!mesh_.vertex_ids.empty()) piece.vertex_ids.push_back(mesh_.vertex_ids[vertex]);
  }
  cut_cells(part, piece);
  cut_data(part, piece);
  cut_sets(part, piece);
  return piece;
}

std::vector<Index> PartCutter::placed(Association association, std::span<const Index> numbers) const {
  const std::vector<Index>& places = association == Association::vertices ? vertex_places_ : cell_places_;
  std::vector<Index> result(numbers.size());
  std::transform(numbers.begin(), numbers.end(), result.begin(),
                 [&](Index number) { return places[number]; });
  return result;
}

void PartCutter::cut_cells(Index part, Mesh& piece) const {
  for (const Index cell : parts_.cells(part)) {
    piece.cells.push_back(mesh_.cells.shapes[cell], placed(Association::vertices, mesh_.cells[cell]));
    if (!mesh_.cell_ids.empty()) piece.cell_ids.push_back(mesh_.cell_ids[cell]);
  }
}

void PartCutter::cut_data(Index part, Mesh& piece) const {
  for (std::size_t a = 0; a < mesh_.data.size(); ++a) {
    const DataArray& array = mesh_.data[a];
    const auto all = array.association == Association::vertices ? parts_.vertices(part) : parts_.cells(part);
    const auto rows = array.is_dense() ? all : rows_[a][part];
    if (rows.empty() && !array.is_dense()) continue;  // an array without indices would count as dense
    DataArray cut{array.name, array.association, array.components, {}, {}, array.component_names};
    cut.values = rows_of_values(array.values, array.components, rows);
    if (!array.is_dense()) {
      std::vector<Index> numbers;
      for (const Index row : rows) numbers.push_back(array.indices[row]);
      cut.indices = placed(array.association, numbers);
    }
    piece.data.push_back(std::move(cut));
  }
}

void PartCutter::cut_sets(Index part, Mesh& piece) const {
  for (std::size_t s = 0; s < mesh_.sets.size(); ++s) {
    const EntitySet& set = mesh_.sets[s];
    std::vector<Index> numbers;
    for (const Index place : members_[s][part]) numbers.push_back(set.members[place]);
    piece.sets.push_back({set.name, set.association, placed(set.association, numbers)});
  }
}

}  // namespace meshorder::distributed
