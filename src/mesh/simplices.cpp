// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/simplices.hpp"

#include "base/parallel.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Returns the simplices of a cell: for each simplex, the positions of its corners in the cell.
std::vector<int> pieces(Shape shape, int vertices) {
  switch (shape) {
    case Shape::line:
      return {0, 1};
    case Shape::tetrahedron:
      return {0, 1, 2, 3};
    case Shape::pyramid:
      return {0, 1, 2, 4, 0, 2, 3, 4};
    case Shape::wedge:
      return {0, 1, 2, 3, 1, 4, 2, 3, 2, 4, 5, 3};
    case Shape::hexahedron:  // around the diagonal from 0 to 6
      return {0, 1, 2, 6, 0, 2, 3, 6, 0, 3, 7, 6, 0, 7, 4, 6, 0, 4, 5, 6, 0, 5, 1, 6};
    case Shape::polyline: {
      std::vector<int> lines;
      for (int i = 1; i < vertices; ++i) lines.insert(lines.end(), {i - 1, i});
      return lines;
    }
    case Shape::triangle:
    case Shape::quad:
    case Shape::polygon: {
      std::vector<int> fan;
      for (int i = 2; i < corners(shape, vertices); ++i) fan.insert(fan.end(), {0, i - 1, i});
      return fan;
    }
    case Shape::triangle_strip: {
      std::vector<int> strip;
      for (int i = 2; i < vertices; ++i) strip.insert(strip.end(), {i - 2, i - 1, i});
      return strip;
    }
    case Shape::polyhedron: {
      std::vector<int> chain;
      for (int i = 3; i < vertices; ++i) chain.insert(chain.end(), {i - 3, i - 2, i - 1, i});
      return chain;
    }
    case Shape::vertex:
    case Shape::poly_vertex:
      return {};
  }
  return {};
}

/// Returns whether every cell is a simplex of that dimension, without mid-side nodes.
bool are_simplices(const Cells& cells, int dimension) {
  constexpr std::array kShapes{Shape::vertex, Shape::line, Shape::triangle, Shape::tetrahedron};
  const auto of_shape = [&](Shape shape) { return shape == kShapes[dimension]; };
  return dimension > 0 && Offset{cells.size()} * (dimension + 1) == std::ssize(cells.vertices) &&
         std::all_of(cells.shapes.begin(), cells.shapes.end(), of_shape);
}

}  // namespace

Simplices cut_into_simplices(const Mesh& mesh) {
  Simplices result;
  result.dimension = std::max(0, mesh.cells.highest_dimension());
  if (result.dimension == 0) return result;
  result.vertices.reserve(mesh.cells.vertices.size());
  result.cells.reserve(mesh.cells.shapes.size());
  Shape shape = Shape::vertex;
  int vertices = 0;
  std::vector<int> cut;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (dimension(mesh.cells.shapes[c]) != result.dimension) continue;
    if (mesh.cells.shapes[c] != shape || mesh.cells.vertex_count(c) != vertices) {
      shape = mesh.cells.shapes[c];
      vertices = mesh.cells.vertex_count(c);
      cut = pieces(shape, vertices);
    }
    for (const int corner : cut) result.vertices.push_back(mesh.cells[c][corner]);
    result.cells.insert(result.cells.end(), cut.size() / (result.dimension + 1), c);
  }
  return result;
}

CellSimplices::CellSimplices(const Mesh& mesh) {
  const int dimension = std::max(0, mesh.cells.highest_dimension());
  if (are_simplices(mesh.cells, dimension)) {
    ref_ = {dimension, mesh.cells.vertices};
    return;
  }
  Simplices cut = cut_into_simplices(mesh);
  own_ = std::move(cut.vertices);
  ref_ = {dimension, own_};
  starts_.assign(mesh.cells.offsets.size(), 0);
  for (const Index cell : cut.cells) ++starts_[cell + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
}

CellSimplices CellSimplices::moved(const Permutation& vertices, const Permutation& cells) const {
  constexpr Index kCellsAtOnce = 65536;
  const Offset corners = ref_.dimension + 1;
  CellSimplices result;
  if (!starts_.empty()) {
    result.starts_.assign(starts_.size(), 0);
    for (Index c = 0; c < cells.size(); ++c) {
      const Index old = cells.new_to_old()[c];
      result.starts_[c + 1] = result.starts_[c] + starts_[old + 1] - starts_[old];
    }
  }
  result.own_.resize(ref_.vertices.size());
  result.ref_ = {ref_.dimension, result.own_};
  if (ref_.dimension == 0) return result;
  const auto first_of = [](const std::vector<Offset>& starts, Index cell) {
    return starts.empty() ? Offset{cell} : starts[cell];
  };
  for_each_chunk(cells.size(), kCellsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index c = begin; c < end; ++c) {
      const Index old = cells.new_to_old()[c];
      std::transform(ref_.vertices.begin() + corners * first_of(starts_, old),
                     ref_.vertices.begin() + corners * first_of(starts_, old + 1),
                     result.own_.begin() + corners * first_of(result.starts_, c),
                     [&](Index v) { return vertices.old_to_new()[v]; });
    }
  });
  return result;
}

}  // namespace meshorder
