// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/reorder.hpp"

#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "graph/incidence.hpp"
#include "mesh/graphs.hpp"
#include "mesh/groups.hpp"
#include "mesh/stored_matrix.hpp"
#include "ordering/grouped.hpp"
#include "ordering/moved.hpp"
#include "ordering/order_cells.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <string>

namespace meshorder {
namespace {

Index class_count(const Mesh& mesh) { return 4 * std::max<Index>(1, index_size(mesh.cell_blocks)); }

/// Returns the cells in a new order, with new numbers of vertices.
Cells reordered(Cells&& cells, const Permutation& vertices, const Permutation& order) {
  constexpr Index kCellsAtOnce = 65536;
  constexpr Index kAhead = 16;  // cells lie anywhere in memory: prefetch them early
  const std::span<const Index> new_to_old = order.new_to_old();
  const std::span<const Index> new_number = vertices.old_to_new();
  const auto for_cells = [&](auto work) {
    for_each_chunk(cells.size(), kCellsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
      for (Index c = begin; c < end; ++c) work(c, new_to_old[c], new_to_old[std::min(c + kAhead, end - 1)]);
    });
  };
  const Offset size = common_size({vertices.size(), cells.offsets, cells.vertices});
  const auto begin_of = [&](Index cell) { return size > 0 ? size * cell : cells.offsets[cell]; };
  Cells result;
  result.shapes = moved(order, cells.shapes);
  resize_large(result.vertices, cells.vertices.size());
  if (size == 0) {
    result.offsets.resize(cells.offsets.size());
    for_cells([&](Index c, Index old, Index ahead) {
      __builtin_prefetch(&cells.offsets[ahead]);
      result.offsets[c + 1] = cells.vertex_count(old);
    });
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  }
  for_cells([&](Index c, Index old, Index ahead) {
    __builtin_prefetch(cells.vertices.data() + begin_of(ahead));
    const Index* const from = cells.vertices.data() + begin_of(old);
    Index* const to = result.vertices.data() + (size > 0 ? size * c : result.offsets[c]);
    std::transform(from, from + (size > 0 ? size : cells.vertex_count(old)), to,
                   [&](Index v) { return new_number[v]; });
  });
  if (size > 0) result.offsets = std::move(cells.offsets);  // last: if a loop throws, `cells` is still whole
  return result;
}

void reorder_data(DataArray& array, const Permutation& order) {
  if (array.is_dense()) {
    const auto width = static_cast<std::size_t>(array.components);
    std::visit([&](auto& values) { values = moved(order, values, width); }, array.values);
  } else {
    for (Index& row : array.indices) row = order.old_to_new()[row];
  }
}

/// Sorts the ids of each class and puts them at the positions of that class; without classes, sorts all ids.
void sort_ids_within_classes(std::vector<std::int64_t>& ids, const std::vector<Index>& classes, Index count) {
  if (classes.empty()) return std::sort(ids.begin(), ids.end());
  std::vector<std::vector<std::int64_t>> by_class(count);
  for (std::size_t c = 0; c < ids.size(); ++c) by_class[classes[c]].push_back(ids[c]);
  for (auto& of_class : by_class) std::sort(of_class.begin(), of_class.end());
  std::vector<std::size_t> next(count, 0);
  for (std::size_t c = 0; c < ids.size(); ++c) ids[c] = by_class[classes[c]][next[classes[c]]++];
}

/// Moves vertices and cells with their arrays, sets and format metadata, but not ids and blocks.
void move_all(Mesh& mesh, const Permutation& vertices, const Permutation& cells) {
  mesh.points = moved(vertices, mesh.points);
  mesh.cells = reordered(std::move(mesh.cells), vertices, cells);
  for (DataArray& array : mesh.data)
    reorder_data(array, array.association == Association::vertices ? vertices : cells);
  for (EntitySet& set : mesh.sets) {
    const Permutation& order = set.association == Association::vertices ? vertices : cells;
    for (Index& member : set.members) member = order.old_to_new()[member];
  }
  if (!mesh.format_metadata) return;
  if (auto metadata = mesh.format_metadata->moved(vertices.old_to_new(), cells.old_to_new())) {
    mesh.format_metadata = std::move(metadata);
  }
}

void move_ids(std::vector<std::int64_t>& ids, const Permutation& order) {
  if (!ids.empty()) ids = moved(order, ids);
}

/// Attaches the ids, or the positions if there are none, as the arrays `kOriginal`.
void attach_ids(Mesh& mesh) {
  for (const Association association : {Association::vertices, Association::cells}) {
    if (find_array(mesh, kOriginal, association) != nullptr) {
      throw InvalidArgument("reorder: the mesh has an array '" + std::string(kOriginal) + "' on " +
                            std::string(to_string(association)) + " already");
    }
  }
  const auto attach = [&](Association association, std::vector<std::int64_t> ids, Index count) {
    if (ids.empty()) {
      ids.resize(static_cast<std::size_t>(count));
      std::iota(ids.begin(), ids.end(), std::int64_t{0});
    }
    mesh.data.push_back(
        {.name = std::string(kOriginal), .association = association, .values = std::move(ids)});
  };
  attach(Association::vertices, mesh.vertex_ids, mesh.vertex_count());
  attach(Association::cells, mesh.cell_ids, mesh.cell_count());
}

void check_fits(const Mesh& mesh, const Permutation& vertices, const Permutation& cells) {
  if (vertices.size() != mesh.vertex_count() || cells.size() != mesh.cell_count()) {
    throw InvalidArgument("reorder: permutations of " + std::to_string(vertices.size()) + " vertices and " +
                          std::to_string(cells.size()) + " cells for a mesh of " +
                          std::to_string(mesh.vertex_count()) + " and " + std::to_string(mesh.cell_count()));
  }
}

}  // namespace

MeshOrder compute_reordering(const Mesh& mesh, const CsrGraph& graph, const ReorderOptions& options) {
  OrderOptions ordering = options.order;
  Grouping groups;
  MeshOrder result;
  const Stopwatch vertices;
  if (!options.group_by.empty()) {
    if (!ordering.groups.empty() || !ordering.cell_groups.empty()) {
      throw InvalidArgument("reorder: groups are given by name and by number; give one of them");
    }
    groups = grouping_by(mesh, options.group_by);
    ordering.groups = groups.of_vertices;
    if (groups.association == Association::cells) ordering.cell_groups = groups.of_cells;
  }
  result.vertices = order_vertices_by_options(options.methods.vertices, {graph, mesh.points}, ordering);
  result.vertices.seconds = vertices.seconds();
  const Stopwatch cells;
  // the speed of a product depends on the order of rows, not on the place of an entry in the file
  const bool stay = options.methods.elements == "auto" && stored_matrix(mesh) != nullptr;
  result.cells = order_cells(stay ? "original" : options.methods.elements, cell_arrays(mesh),
                             result.vertices.permutation, mesh.points, ordering.cell_groups, ordering);
  if (stay) result.cells.method.reason = "entries keep their places in the file";
  result.cells.seconds = cells.seconds();
  return result;
}

void apply_reordering(Mesh& mesh, const MeshOrder& order, Ids ids) {
  move_mesh(mesh, order.vertices.permutation, order.cells.permutation, ids);
}

void move_mesh(Mesh& mesh, const Permutation& vertices, const Permutation& cells, Ids ids) {
  check_fits(mesh, vertices, cells);
  const CellArrays arrays = cell_arrays(mesh);
  const std::vector<Index> classes = has_one_slot_class(arrays) ? std::vector<Index>{} : slot_classes(arrays);
  for (Index c = 0; c < index_size(classes); ++c) {
    if (classes[cells.old_to_new()[c]] != classes[c]) {
      throw InvalidArgument("reorder: cell " + std::to_string(c) +
                            " would leave its block or take the place of a cell of another dimension");
    }
  }
  if (ids == Ids::attach) attach_ids(mesh);
  move_all(mesh, vertices, cells);
  // an order that moves nothing leaves the ids as they are
  if (ids == Ids::keep) {
    move_ids(mesh.vertex_ids, vertices);
    move_ids(mesh.cell_ids, cells);
    return;
  }
  if (!vertices.is_identity()) std::sort(mesh.vertex_ids.begin(), mesh.vertex_ids.end());
  if (!mesh.cell_ids.empty() && !cells.is_identity()) {
    sort_ids_within_classes(mesh.cell_ids, classes, class_count(mesh));
  }
}

namespace {

/// Returns the sort key that cells of one type share: −dimension, shape, number of vertices. The highest
/// dimension comes first.
std::array<int, 3> type_of(const Cells& cells, Index c) {
  const Shape shape = cells.shapes[c];
  return {-dimension(shape), static_cast<int>(shape), cells.vertex_count(c)};
}

bool have_one_type(const Cells& cells, Index a, Index b) {
  return cells.shapes[a] == cells.shapes[b] && cells.vertex_count(a) == cells.vertex_count(b);
}

/// Moves the cells with their arrays, sets and ids, also from block to block.
void move_cells(Mesh& mesh, const Permutation& places) {
  if (places.is_identity()) return;
  move_all(mesh, Permutation::identity(mesh.vertex_count()), places);
  move_ids(mesh.cell_ids, places);
}

}  // namespace

std::optional<Permutation> places_by_type(const Cells& cells) {
  Index sorted = 1;
  while (sorted < cells.size() &&
         (have_one_type(cells, sorted - 1, sorted) || type_of(cells, sorted - 1) < type_of(cells, sorted))) {
    ++sorted;
  }
  if (sorted >= cells.size()) return {};
  std::vector<Index> new_to_old(cells.shapes.size());
  std::iota(new_to_old.begin(), new_to_old.end(), Index{0});
  std::stable_sort(new_to_old.begin(), new_to_old.end(),
                   [&](Index a, Index b) { return type_of(cells, a) < type_of(cells, b); });
  return Permutation::from_new_to_old(std::move(new_to_old));
}

std::optional<Permutation> group_cells_by_type(Mesh& mesh) {
  std::optional<Permutation> places = places_by_type(mesh.cells);
  if (places) move_cells(mesh, *places);
  mesh.cell_blocks.clear();
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (c == 0 || !have_one_type(mesh.cells, c - 1, c)) mesh.cell_blocks.push_back(c);
  }
  return places;
}

void restore_cells(Mesh& mesh, const Permutation& arranged, std::vector<Index> blocks) {
  move_cells(mesh, arranged.inverse());
  mesh.cell_blocks = std::move(blocks);
}

}  // namespace meshorder
