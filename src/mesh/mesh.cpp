// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/point.hpp"
#include "cells/cell_arrays.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>

namespace meshorder {
inline namespace v0_3 {
namespace {

[[noreturn]] void fail(const std::string& what) { throw InvalidArgument("mesh: " + what); }

void check_members(const std::vector<Index>& members, Index count, const std::string& owner) {
  const bool are_in_range = holds_for_all(std::ssize(members), [&](Offset begin, Offset end) {
    return all_below(std::span(members).subspan(begin, end - begin), count);
  });
  if (are_in_range) return;
  const auto wrong = std::find_if(members.begin(), members.end(),
                                  [&](Index member) { return member < 0 || member >= count; });
  fail(owner + " names " + std::to_string(*wrong) + ", outside 0 … " + std::to_string(count - 1));
}

/// Returns for each byte the least number of vertices of a cell whose shape has that byte; for bytes that are
/// no shape, a number that no cell reaches.
constexpr std::size_t kBytes = 256;
std::array<Offset, kBytes> least_vertices() {
  std::array<Offset, kBytes> least{};
  least.fill(std::numeric_limits<Offset>::max());
  for (int shape = 0; shape < kShapes; ++shape)
    least[shape] = std::max(1, corners(static_cast<Shape>(shape), 1));
  return least;
}

/// Throws for the first cell with an unknown shape or, if there is none, with too few vertices.
[[noreturn]] void fail_for_cell(const Cells& cells, const std::array<Offset, kBytes>& least) {
  const auto unknown = std::find_if(cells.shapes.begin(), cells.shapes.end(),
                                    [](Shape shape) { return static_cast<int>(shape) >= kShapes; });
  if (unknown != cells.shapes.end()) {
    fail("cell " + std::to_string(unknown - cells.shapes.begin()) + " has the shape " +
         std::to_string(static_cast<int>(*unknown)) + ", which is not a value of Shape");
  }
  Index c = 0;
  while (cells.vertex_count(c) >= least[static_cast<std::size_t>(cells.shapes[c])]) ++c;
  fail("cell " + std::to_string(c) + " has too few vertices for a " +
       std::string(to_string(cells.shapes[c])));
}

void check_cells(const Mesh& mesh) {
  const Cells& cells = mesh.cells;
  const Offset count = std::ssize(cells.shapes);
  const bool fit = std::ssize(cells.offsets) == count + 1 && cells.offsets.front() == 0 &&
                   cells.offsets.back() == std::ssize(cells.vertices) &&
                   holds_for_all(count, [&](Offset begin, Offset end) {
                     bool rise = true;
                     for (Offset c = begin; c < end; ++c) rise &= cells.offsets[c] <= cells.offsets[c + 1];
                     return rise;
                   });
  if (!fit) fail("offsets do not fit the cells");
  const std::array<Offset, kBytes> least = least_vertices();
  const bool have_enough = holds_for_all(count, [&](Offset begin, Offset end) {
    bool enough = true;
    for (Offset c = begin; c < end; ++c)
      enough &= cells.offsets[c + 1] - cells.offsets[c] >= least[static_cast<std::uint8_t>(cells.shapes[c])];
    return enough;
  });
  if (!have_enough) fail_for_cell(cells, least);
  check_members(cells.vertices, mesh.vertex_count(), "a cell");
}

void check_points(const Mesh& mesh) {
  const auto is_finite = [&](Offset v) {
    const Point& p = mesh.points[v];
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  };
  const bool are_finite = holds_for_all(std::ssize(mesh.points), [&](Offset begin, Offset end) {
    bool all = true;
    for (Offset v = begin; v < end; ++v) all &= is_finite(v);
    return all;
  });
  if (are_finite) return;
  Offset v = 0;
  while (is_finite(v)) ++v;
  fail("vertex " + std::to_string(v) + " has a coordinate that is not finite");
}

/// Checks lists of vertices and of cells.
class ListChecks {
 public:
  explicit ListChecks(const Mesh& mesh) : mesh_(mesh) {}

  /// Throws if a number does not exist or comes twice. O(list), and once O(vertices or cells) for the lists
  /// that do not ascend.
  void check(const std::vector<Index>& members, Association association, const std::string& owner) {
    const Index count = association == Association::vertices ? mesh_.vertex_count() : mesh_.cell_count();
    check_members(members, count, owner);
    if (std::ranges::adjacent_find(members, std::greater_equal<>()) == members.end()) return;
    std::vector<Index>& last_list = last_list_[association == Association::vertices ? 0 : 1];
    last_list.resize(static_cast<std::size_t>(count));
    ++lists_;
    for (const Index member : members) {
      Index& last = last_list[static_cast<std::size_t>(member)];
      if (last == lists_) fail(owner + " names " + std::to_string(member) + " twice");
      last = lists_;
    }
  }

 private:
  const Mesh& mesh_;
  Index lists_ = 0;                              // lists so far that do not ascend
  std::array<std::vector<Index>, 2> last_list_;  // the last of them with a vertex, and with a cell
};

void check_data(const Mesh& mesh) {
  ListChecks lists(mesh);
  for (const DataArray& array : mesh.data) {
    const Index count = array.association == Association::vertices ? mesh.vertex_count() : mesh.cell_count();
    const std::string owner = "array '" + array.name + "'";
    const Index expected = array.is_dense() ? count : index_size(array.indices);
    if (array.components < 1) fail(owner + " has " + std::to_string(array.components) + " components");
    if (row_count(array) != expected ||
        size_of(array.values) % static_cast<std::size_t>(array.components) != 0) {
      fail(owner + " has " + std::to_string(row_count(array)) + " rows for " + std::to_string(expected));
    }
    lists.check(array.indices, array.association, owner);
  }
  for (const EntitySet& set : mesh.sets) lists.check(set.members, set.association, "set '" + set.name + "'");
}

void check_numbering(const Mesh& mesh) {
  if (!mesh.vertex_ids.empty() && index_size(mesh.vertex_ids) != mesh.vertex_count()) {
    fail("ids do not fit the vertices");
  }
  if (!mesh.cell_ids.empty() && index_size(mesh.cell_ids) != mesh.cell_count()) {
    fail("ids do not fit the cells");
  }
  if (!mesh.cell_blocks.empty() &&
      (mesh.cell_blocks.front() != 0 || !std::is_sorted(mesh.cell_blocks.begin(), mesh.cell_blocks.end()) ||
       mesh.cell_blocks.back() > mesh.cell_count())) {
    fail("blocks of cells must ascend from 0 and begin at cells");
  }
}

}  // namespace

void Cells::push_back(Shape shape, std::span<const Index> cell_vertices) {
  shapes.push_back(shape);
  vertices.insert(vertices.end(), cell_vertices.begin(), cell_vertices.end());
  offsets.push_back(static_cast<Offset>(vertices.size()));
}

void Cells::reserve(Offset cells, Offset vertex_entries) {
  reserve_large(shapes, static_cast<std::size_t>(cells));
  reserve_large(offsets, static_cast<std::size_t>(cells) + 1);
  reserve_large(vertices, static_cast<std::size_t>(vertex_entries));
}

int Cells::highest_dimension() const {
  int highest = -1;
  for (int shape = 0; shape < kShapes; ++shape) {
    const auto s = static_cast<Shape>(shape);
    if (dimension(s) > highest && std::find(shapes.begin(), shapes.end(), s) != shapes.end()) {
      highest = dimension(s);
    }
  }
  return highest;
}

std::string_view to_string(Association association) {
  return association == Association::vertices ? "vertices" : "cells";
}

Index row_count(const DataArray& array) {
  return static_cast<Index>(size_of(array.values) / static_cast<std::size_t>(array.components));
}

const DataArray* find_array(const Mesh& mesh, std::string_view name, Association association) {
  const auto found = std::find_if(mesh.data.begin(), mesh.data.end(), [&](const DataArray& array) {
    return array.association == association && array.name == name;
  });
  return found == mesh.data.end() ? nullptr : &*found;
}

void check_mesh(const Mesh& mesh) {
  in_arena({}, [&] {
    check_points(mesh);
    check_cells(mesh);
    check_data(mesh);
    check_numbering(mesh);
  });
}

MeshView view(const Mesh& mesh) {
  return {.points = PointsView(mesh.points),
          .cells = CellsView::mixed(mesh.cells.offsets, mesh.cells.vertices, mesh.cells.shapes)};
}

Mesh make_mesh(const MeshView& view) {
  const std::size_t n = vertex_count_of(view);
  const CellArrays cells = cell_arrays(view.cells, n, Check::full);
  if (cells.shapes.empty() && cells.size() > 0) fail("the types of the cells are not known");
  if (view.points.size() != n) {
    fail(std::to_string(view.points.size()) + " points for " + std::to_string(n) + " vertices");
  }
  Mesh mesh;
  mesh.dimension = view.points.dimension() == 2 ? 2 : 3;
  mesh.points.resize(n);
  for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.points[v] = point_at(view.points, v);
  mesh.cells.shapes.assign(cells.shapes.begin(), cells.shapes.end());
  mesh.cells.offsets.assign(cells.offsets.begin(), cells.offsets.end());
  mesh.cells.vertices.assign(cells.vertices.begin(), cells.vertices.end());
  mesh.cell_blocks.assign(cells.block_starts.begin(), cells.block_starts.end());
  check_mesh(mesh);
  return mesh;
}

}  // namespace v0_3
}  // namespace meshorder
