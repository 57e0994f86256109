// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/mesh.hpp"

#include "base/parallel.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

[[noreturn]] void fail(const std::string& what) { throw InvalidArgument("mesh: " + what); }

void check_members(const std::vector<Index>& members, Index count, const std::string& owner) {
  for (const Index member : members) {
    if (member < 0 || member >= count) {
      fail(owner + " names " + std::to_string(member) + ", outside 0 … " + std::to_string(count - 1));
    }
  }
}

void check_cells(const Mesh& mesh) {
  const Cells& cells = mesh.cells;
  if (cells.offsets.size() != cells.shapes.size() + 1 || cells.offsets.front() != 0 ||
      cells.offsets.back() != static_cast<Offset>(cells.vertices.size())) {
    fail("offsets do not fit the cells");
  }
  for (Index c = 0; c < cells.size(); ++c) {
    if (cells.vertex_count(c) < std::max(1, corners(cells.shapes[c], 1))) {
      fail("cell " + std::to_string(c) + " has too few vertices for a " +
           std::string(to_string(cells.shapes[c])));
    }
  }
  check_members(cells.vertices, mesh.vertex_count(), "a cell");
}

void check_data(const Mesh& mesh) {
  for (const DataArray& array : mesh.data) {
    const Index count = array.association == Association::vertices ? mesh.vertex_count() : mesh.cell_count();
    const std::string owner = "array '" + array.name + "'";
    const Index expected = array.is_dense() ? count : index_size(array.indices);
    if (array.components < 1 || row_count(array) != expected) {
      fail(owner + " has " + std::to_string(row_count(array)) + " rows for " + std::to_string(expected));
    }
    check_members(array.indices, count, owner);
  }
  for (const EntitySet& set : mesh.sets) {
    check_members(set.members,
                  set.association == Association::vertices ? mesh.vertex_count() : mesh.cell_count(),
                  "set '" + set.name + "'");
  }
}

void check_numbering(const Mesh& mesh) {
  if (!mesh.vertex_ids.empty() && index_size(mesh.vertex_ids) != mesh.vertex_count()) {
    fail("ids do not fit the vertices");
  }
  if (!mesh.cell_ids.empty() && index_size(mesh.cell_ids) != mesh.cell_count()) {
    fail("ids do not fit the cells");
  }
  if (!mesh.cell_blocks.empty() &&
      (mesh.cell_blocks.front() != 0 || !std::is_sorted(mesh.cell_blocks.begin(), mesh.cell_blocks.end()))) {
    fail("blocks of cells must ascend from 0");
  }
}

}  // namespace

Index row_count(const DataArray& array) {
  const auto entries = std::visit([](const auto& values) { return values.size(); }, array.values);
  return static_cast<Index>(entries / static_cast<std::size_t>(array.components));
}

const DataArray* find_array(const Mesh& mesh, std::string_view name, Association association) {
  const auto found = std::find_if(mesh.data.begin(), mesh.data.end(), [&](const DataArray& array) {
    return array.association == association && array.name == name;
  });
  return found == mesh.data.end() ? nullptr : &*found;
}

void check_mesh(const Mesh& mesh) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (const double x : mesh.points[v]) {
      if (!std::isfinite(x)) fail("vertex " + std::to_string(v) + " has a coordinate that is not finite");
    }
  }
  check_cells(mesh);
  check_data(mesh);
  check_numbering(mesh);
}

std::vector<Index> degenerate_cells(const Mesh& mesh) {
  constexpr Index kCellsAtOnce = 65536;
  std::vector<std::vector<Index>> found(chunk_count(mesh.cell_count(), kCellsAtOnce));
  for_each_chunk(mesh.cell_count(), kCellsAtOnce, [&](Index chunk, Index begin, Index end) {
    std::vector<Index> sorted;
    for (Index c = begin; c < end; ++c) {
      const auto vertices = mesh.cells[c];
      sorted.assign(vertices.begin(), vertices.end());
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) found[chunk].push_back(c);
    }
  });
  std::vector<Index> result;
  for (const std::vector<Index>& cells : found) result.insert(result.end(), cells.begin(), cells.end());
  return result;
}

}  // namespace meshorder
