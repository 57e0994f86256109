// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

template <class Wanted>
CellIncidence cells_that(const Mesh& mesh, Wanted wanted) {
  CellIncidence result;
  result.incidence.vertex_count = mesh.vertex_count();
  const std::vector<Shape>& shapes = mesh.cells.shapes;
  const auto left_out = std::find_if(shapes.begin(), shapes.end(), [&](Shape s) { return !wanted(s); });
  if (left_out == shapes.end()) {
    result.cells.resize(shapes.size());
    std::iota(result.cells.begin(), result.cells.end(), Index{0});
    result.incidence.offsets = mesh.cells.offsets;
    result.incidence.vertices = mesh.cells.vertices;
    return result;
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (!wanted(shapes[c])) continue;
    result.cells.push_back(c);
    const auto vertices = mesh.cells[c];
    result.incidence.vertices.insert(result.incidence.vertices.end(), vertices.begin(), vertices.end());
    result.incidence.offsets.push_back(static_cast<Offset>(result.incidence.vertices.size()));
  }
  return result;
}

/// The corners of a facet, falling, −1 where there are fewer than four, and the element that it bounds.
struct Facet {
  std::array<Index, 4> corners;
  Index element;
};

std::vector<Facet> all_facets(const Mesh& mesh) {
  std::vector<Facet> result;
  // the corners' positions are the same for all cells of a type
  std::map<std::pair<Shape, int>, std::vector<std::vector<int>>> by_type;
  const CellIncidence top = elements(mesh);
  for (Index e = 0; e < index_size(top.cells); ++e) {
    const Index c = top.cells[e];
    const auto type = std::pair(mesh.cells.shapes[c], mesh.cells.vertex_count(c));
    auto found = by_type.find(type);
    if (found == by_type.end()) found = by_type.emplace(type, facets(type.first, type.second)).first;
    for (const std::vector<int>& positions : found->second) {
      Facet facet{{-1, -1, -1, -1}, e};
      for (std::size_t k = 0; k < positions.size(); ++k) facet.corners[k] = mesh.cells[c][positions[k]];
      std::sort(facet.corners.begin(), facet.corners.end(), std::greater<>());
      result.push_back(facet);
    }
  }
  return result;
}

/// The facets with the same largest corner together, in the order of those corners.
std::vector<Facet> bucketed(const std::vector<Facet>& all, std::vector<Offset>& starts) {
  for (const Facet& facet : all) ++starts[facet.corners[0] + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Offset> next(starts.begin(), starts.end() - 1);
  std::vector<Facet> result(all.size());
  for (const Facet& facet : all) result[next[facet.corners[0]]++] = facet;
  return result;
}

}  // namespace

CellIncidence elements(const Mesh& mesh) {
  const int highest = mesh.cells.highest_dimension();
  return cells_that(mesh, [&](Shape shape) { return dimension(shape) == highest; });
}

CellIncidence lower_dimensional_cells(const Mesh& mesh) {
  const int highest = mesh.cells.highest_dimension();
  return cells_that(mesh, [&](Shape shape) { return dimension(shape) < highest; });
}

CsrGraph vertex_graph(const Mesh& mesh) { return vertex_graph(elements(mesh).incidence); }

CsrGraph facet_graph(const Mesh& mesh) {
  std::vector<Offset> starts(mesh.points.size() + 1, 0);
  std::vector<Facet> sorted = bucketed(all_facets(mesh), starts);
  std::vector<Edge> joins;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const auto begin = sorted.begin() + starts[v];
    const auto end = sorted.begin() + starts[v + 1];
    std::sort(begin, end, [](const Facet& a, const Facet& b) {
      return a.corners != b.corners ? a.corners < b.corners : a.element < b.element;
    });
    // a facet of more than two elements joins each to the next, which keeps them together
    for (auto facet = begin; facet != end; ++facet) {
      const auto next = facet + 1;
      if (next != end && next->corners == facet->corners) joins.push_back({facet->element, next->element});
    }
  }
  const Index count = index_size(elements(mesh).cells);
  return graph_from_edges(count, joins);
}

}  // namespace meshorder
