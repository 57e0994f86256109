// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/reorder.hpp"

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "mesh/graphs.hpp"
#include "ordering/grouped.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// Returns the slot class of each cell, block × dimension: only cells of one class may swap positions.
std::vector<Index> slot_classes(const Mesh& mesh) {
  std::vector<Index> classes(mesh.cells.shapes.size());
  Index block = 0;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    while (block + 1 < index_size(mesh.cell_blocks) && mesh.cell_blocks[block + 1] <= c) ++block;
    classes[c] = 4 * block + dimension(mesh.cells.shapes[c]);
  }
  return classes;
}

Index class_count(const Mesh& mesh) { return 4 * std::max<Index>(1, index_size(mesh.cell_blocks)); }

/// Returns whether all cells have one class, as in most meshes.
bool is_one_class(const std::vector<Index>& classes) {
  return std::all_of(classes.begin(), classes.end(), [&](Index k) { return k == classes.front(); });
}

Cells reordered(const Cells& cells, const Permutation& vertices, const Permutation& order) {
  constexpr Index kCellsAtOnce = 65536;
  const auto for_cells = [&](auto work) {
    for_each_chunk(cells.size(), kCellsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
      for (Index c = begin; c < end; ++c) work(c, order.new_to_old()[c]);
    });
  };
  Cells result;
  result.shapes = order.moved(cells.shapes);
  result.offsets.resize(cells.offsets.size());
  for_cells([&](Index c, Index old) { result.offsets[c + 1] = cells.vertex_count(old); });
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.vertices.resize(cells.vertices.size());
  for_cells([&](Index c, Index old) {
    std::transform(cells[old].begin(), cells[old].end(), result[c].begin(),
                   [&](Index v) { return vertices.old_to_new()[v]; });
  });
  return result;
}

void reorder_data(DataArray& array, const Permutation& order) {
  if (array.is_dense()) {
    const auto width = static_cast<std::size_t>(array.components);
    std::visit([&](auto& values) { values = order.moved(values, width); }, array.values);
  } else {
    for (Index& row : array.indices) row = order.old_to_new()[row];
  }
}

/// Sorts the ids of each class, ascending along the positions of that class.
void sort_ids_within_classes(std::vector<std::int64_t>& ids, const std::vector<Index>& classes, Index count) {
  std::vector<std::vector<std::int64_t>> by_class(count);
  for (std::size_t c = 0; c < ids.size(); ++c) by_class[classes[c]].push_back(ids[c]);
  for (auto& of_class : by_class) std::sort(of_class.begin(), of_class.end());
  std::vector<std::size_t> next(count, 0);
  for (std::size_t c = 0; c < ids.size(); ++c) ids[c] = by_class[classes[c]][next[classes[c]]++];
}

/// Moves vertices and cells with their arrays and sets, but not ids and blocks.
void move_all(Mesh& mesh, const Permutation& vertices, const Permutation& cells) {
  mesh.points = vertices.moved(mesh.points);
  mesh.cells = reordered(mesh.cells, vertices, cells);
  for (DataArray& array : mesh.data)
    reorder_data(array, array.association == Association::vertices ? vertices : cells);
  for (EntitySet& set : mesh.sets) {
    const Permutation& order = set.association == Association::vertices ? vertices : cells;
    for (Index& member : set.members) member = order.old_to_new()[member];
  }
}

void check_fits(const Mesh& mesh, const Permutation& vertices, const Permutation& cells) {
  if (vertices.size() != mesh.vertex_count() || cells.size() != mesh.cell_count()) {
    throw InvalidArgument("reorder: permutations of " + std::to_string(vertices.size()) + " vertices and " +
                          std::to_string(cells.size()) + " cells for a mesh of " +
                          std::to_string(mesh.vertex_count()) + " and " + std::to_string(mesh.cell_count()));
  }
}

/// Returns all cells in their new order: elements by their method, then the others by lexmax.
std::vector<Index> cells_in_order(const Mesh& mesh, const ReorderingOptions& options, Reordering& result) {
  const CellIncidence top = elements(mesh);
  const auto facets_of_mesh = [&] { return facet_graph(mesh); };
  Ordering by_method = order_elements(
      options.elements, {top.incidence, result.vertices, mesh.points, facets_of_mesh}, options.ordering);
  result.element_fiedler = std::move(by_method.fiedler);
  result.element_method = std::move(by_method.method);

  std::vector<Index> order;
  order.reserve(mesh.cells.shapes.size());
  for (const Index e : by_method.permutation.new_to_old()) order.push_back(top.cells[e]);
  const CellIncidence lower = lower_dimensional_cells(mesh);
  const std::string_view lower_method = options.elements == "original" ? "original" : "lexmax";
  const Ordering of_lower = order_elements(
      lower_method, {lower.incidence, result.vertices, mesh.points, facets_of_mesh}, options.ordering);
  for (const Index e : of_lower.permutation.new_to_old()) order.push_back(lower.cells[e]);
  if (result.groups && result.groups->association == Association::cells) {
    const std::vector<Index>& group_of = result.groups->of_cells;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return group_of[a] < group_of[b]; });
  }
  return order;
}

}  // namespace

Reordering compute_reordering(const Mesh& mesh, const CsrGraph& graph, const ReorderingOptions& options) {
  Reordering result;
  const Stopwatch vertices;
  if (!options.group_by.empty()) result.groups = grouping_by(mesh, options.group_by);
  Ordering by_method =
      result.groups
          ? order_vertices_in_groups(options.vertices, {graph, mesh.points}, result.groups->of_vertices,
                                     result.groups->count(), options.ordering)
          : order_vertices(options.vertices, {graph, mesh.points}, options.ordering);
  result.vertices = std::move(by_method.permutation);
  result.vertex_fiedler = std::move(by_method.fiedler);
  result.vertex_method = std::move(by_method.method);
  result.vertex_seconds = vertices.seconds();

  const Stopwatch cells;
  result.cells = permutation_within_blocks(mesh, cells_in_order(mesh, options, result));
  result.element_seconds = cells.seconds();
  return result;
}

Reordering reorder(Mesh& mesh, const ReorderingOptions& options) {
  Reordering result = compute_reordering(mesh, vertex_graph(mesh), options);
  apply_reordering(mesh, result.vertices, result.cells);
  return result;
}

void apply_reordering(Mesh& mesh, const Permutation& vertices, const Permutation& cells) {
  check_fits(mesh, vertices, cells);
  const std::vector<Index> classes = slot_classes(mesh);
  const Index to_check = is_one_class(classes) ? 0 : mesh.cell_count();
  for (Index c = 0; c < to_check; ++c) {
    if (classes[cells.old_to_new()[c]] != classes[c]) {
      throw InvalidArgument("reorder: cell " + std::to_string(c) +
                            " would leave its block or take the place of a cell of another dimension");
    }
  }
  move_all(mesh, vertices, cells);
  std::sort(mesh.vertex_ids.begin(), mesh.vertex_ids.end());
  if (!mesh.cell_ids.empty()) sort_ids_within_classes(mesh.cell_ids, classes, class_count(mesh));
}

Permutation permutation_within_blocks(const Mesh& mesh, const std::vector<Index>& cells_in_order) {
  if (cells_in_order.size() != mesh.cells.shapes.size()) {
    throw InvalidArgument("cells: an order of " + std::to_string(cells_in_order.size()) + " for " +
                          std::to_string(mesh.cell_count()) + " cells");
  }
  const std::vector<Index> classes = slot_classes(mesh);
  if (is_one_class(classes)) return Permutation::from_new_to_old(cells_in_order);

  // positions of each class, ascending, one class after another
  std::vector<Index> start(class_count(mesh) + 1, 0);
  for (const Index k : classes) ++start[k + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Index> places(classes.size());
  std::vector<Index> next(start.begin(), start.end() - 1);
  for (Index c = 0; c < mesh.cell_count(); ++c) places[next[classes[c]]++] = c;

  // assign them
  std::copy(start.begin(), start.end() - 1, next.begin());
  std::vector<Index> old_to_new(classes.size(), -1);
  for (const Index c : cells_in_order) old_to_new[c] = places[next[classes[c]]++];
  return Permutation::from_old_to_new(std::move(old_to_new));
}

Permutation group_cells_by_type(Mesh& mesh) {
  const Cells& cells = mesh.cells;
  const auto type = [&](Index c) {
    const Shape shape = cells.shapes[c];
    return std::array<int, 3>{-dimension(shape), static_cast<int>(shape), cells.vertex_count(c)};
  };
  std::vector<Index> new_to_old(cells.shapes.size());
  std::iota(new_to_old.begin(), new_to_old.end(), Index{0});
  std::stable_sort(new_to_old.begin(), new_to_old.end(), [&](Index a, Index b) { return type(a) < type(b); });
  Permutation order = Permutation::from_new_to_old(std::move(new_to_old));
  move_all(mesh, Permutation::identity(mesh.vertex_count()), order);
  if (!mesh.cell_ids.empty()) mesh.cell_ids = order.moved(mesh.cell_ids);
  mesh.cell_blocks.clear();
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (c == 0 || type(c) != type(c - 1)) mesh.cell_blocks.push_back(c);
  }
  return order;
}

}  // namespace meshorder
