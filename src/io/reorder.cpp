// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Reordering a mesh for the format that it will be written in.
#include "mesh/reorder.hpp"

#include "base/parallel.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "ordering/order_cells.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Returns the number that the mesh's file gives to the first vertex or cell if the file has no ids.
std::int64_t first_number(const Mesh& mesh, Association of) {
  const std::span<const Format> formats = all_formats();
  const auto own = std::find_if(formats.begin(), formats.end(),
                                [&](const Format& format) { return format.key() == mesh.format; });
  if (own == formats.end()) return 0;
  return own->first_number_of != nullptr ? own->first_number_of(mesh, of) : own->first_number;
}

/// Stores the numbers that a file gives by position as ids, which move with vertices and cells.
void write_down_ids(Mesh& mesh, bool of_vertices, bool of_cells) {
  if (of_vertices && mesh.vertex_ids.empty()) {
    mesh.vertex_ids.resize(mesh.points.size());
    std::iota(mesh.vertex_ids.begin(), mesh.vertex_ids.end(), first_number(mesh, Association::vertices));
  }
  if (of_cells && mesh.cell_ids.empty()) {
    mesh.cell_ids.resize(mesh.cells.shapes.size());
    std::iota(mesh.cell_ids.begin(), mesh.cell_ids.end(), first_number(mesh, Association::cells));
  }
}

/// Reorders a valid mesh and updates its ids.
void move_with_ids(Mesh& mesh, const Permutation& vertices, const Permutation& cells, Ids ids) {
  const bool has_vertex_ids = !mesh.vertex_ids.empty();
  const bool has_cell_ids = !mesh.cell_ids.empty();
  if (ids == Ids::renumber && mesh.format_metadata && mesh.format_metadata->binds_ids()) ids = Ids::keep;
  if (ids == Ids::keep) write_down_ids(mesh, !vertices.is_identity(), !cells.is_identity());
  try {
    move_mesh(mesh, vertices, cells, ids);
  } catch (...) {
    if (!has_vertex_ids) mesh.vertex_ids.clear();
    if (!has_cell_ids) mesh.cell_ids.clear();
    throw;
  }
}

/// Returns the format in which the mesh will be written: the format called `name`, or the mesh's own format
/// if `name` is empty; null if the mesh has none.
const Format* format_to_write(const Mesh& mesh, const std::string& name) {
  if (!name.empty()) return &format_named(name);
  return mesh.format.empty() ? nullptr : &format_named(mesh.format);
}

/// Reorders `numbers`, one for each cell, as `arranged` reordered the cells.
std::vector<std::int64_t> in_new_order(const IndexView& numbers, const Permutation& arranged) {
  std::vector<std::int64_t> moved;
  moved.reserve(numbers.size());
  for (const Index old : arranged.new_to_old()) moved.push_back(numbers[static_cast<std::size_t>(old)]);
  return moved;
}

}  // namespace

std::optional<Permutation> arrange_cells(Mesh& mesh, const Format& to) {
  if (mesh.format == to.key()) return {};
  if (to.places != nullptr) {
    std::vector<Index> blocks;
    Permutation places = to.places(mesh, blocks);
    restore_cells(mesh, places.inverse(), std::move(blocks));
    return places;
  }
  mesh.cell_blocks.clear();
  if (!to.groups_cells_by_type) return {};
  return group_cells_by_type(mesh);
}

Permutation with_groups_together(const Mesh& mesh, Permutation cells, const Format& to) {
  if (to.together == nullptr) return cells;
  const std::vector<Index> groups = to.together(mesh);
  std::vector<Index> in_order(cells.new_to_old().begin(), cells.new_to_old().end());
  std::ranges::stable_sort(in_order, {}, [&](Index cell) { return groups[cell]; });
  return permutation_within_classes(slot_classes(cell_arrays(mesh)), std::move(in_order));
}

MeshOrder compute_order_in_file(const Mesh& mesh, const CsrGraph& graph, const ReorderOptions& options) {
  MeshOrder order = compute_reordering(mesh, graph, options);
  const Format* const to = format_to_write(mesh, options.format);
  const bool has_groups = !options.group_by.empty() || !options.order.cell_groups.empty();
  const bool is_as_in_file =
      to != nullptr && mesh.format == to->key() && order.cells.method.name == "original";
  if (to != nullptr && !has_groups && !is_as_in_file)
    order.cells.permutation = with_groups_together(mesh, std::move(order.cells.permutation), *to);
  return order;
}

void check_holds_ids(const Format& format, Ids ids) {
  if (ids != Ids::keep || format.holds_ids) return;
  throw InvalidArgument(
      fmt::format("reorder: {} numbers points and cells by position; ids cannot be kept", format.name));
}

Permutation move_in_file(Mesh& mesh, const Permutation& vertices, Permutation cells, const Format* to,
                         const std::optional<Permutation>& arranged, Ids ids) {
  move_with_ids(mesh, vertices, cells, ids);
  if (arranged) cells = arranged->then(cells);
  if (to != nullptr && to->settle_cells != nullptr) cells = cells.then(to->settle_cells(mesh));
  return cells;
}

void apply_reordering(Mesh& mesh, const Format& to, const Permutation& vertices, const Permutation& cells,
                      Ids ids) {
  const std::optional<Permutation> arranged = arrange_cells(mesh, to);
  (void)move_in_file(mesh, vertices, arranged ? arranged->inverse().then(cells) : cells, &to, {}, ids);
}

void undo_reordering(Mesh& mesh, const Format& to, const Permutation& vertices, const Permutation& cells) {
  const bool is_of_format = mesh.format == to.key();
  if (!is_of_format) restore_cells(mesh, cells, {});  // the old order may mix cells that this format groups
  (void)move_in_file(mesh, vertices.inverse(),
                     is_of_format ? cells.inverse() : Permutation::identity(mesh.cell_count()), &to, {},
                     Ids::renumber);
}

inline namespace v0_3 {

MeshOrder reorder(Mesh& mesh, const ReorderOptions& options) {
  if (options.order.check != Check::none) in_arena(options.order.run, [&] { check_mesh(mesh); });
  return in_call(options.order.run, [&] {
    const std::vector<Index> blocks = mesh.cell_blocks;
    std::optional<Permutation> arranged;
    if (!options.format.empty()) {
      const Format& to = format_named(options.format);
      check_holds_ids(to, options.ids);
      arranged = arrange_cells(mesh, to);
    }
    try {
      ReorderOptions of_arranged = options;
      std::vector<std::int64_t> groups;
      if (arranged && options.order.cell_groups.size() == mesh.cells.shapes.size()) {
        groups = in_new_order(options.order.cell_groups, *arranged);
        of_arranged.order.cell_groups = groups;
      }
      // the graph is freed before the arrays move
      MeshOrder order = compute_order_in_file(mesh, vertex_graph(mesh), of_arranged);
      order.cells.permutation =
          move_in_file(mesh, order.vertices.permutation, std::move(order.cells.permutation),
                       format_to_write(mesh, options.format), arranged, options.ids);
      return order;
    } catch (...) {
      if (arranged) restore_cells(mesh, *arranged, {});
      mesh.cell_blocks = blocks;
      throw;
    }
  });
}

void apply_reordering(Mesh& mesh, const Permutation& vertices, const Permutation& cells, Ids ids) {
  check_mesh(mesh);
  move_with_ids(mesh, vertices, cells, ids);
}

}  // namespace v0_3
}  // namespace meshorder
