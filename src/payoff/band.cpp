// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/band.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace meshorder {
namespace {

/// The reach r of each vertex: vertex v is joined to v + 1 … v + r.
using Reaches = std::vector<Index>;

Index joined_vertices(const CsrGraph& graph) {
  Index count = 0;
  for (Index v = 0; v < graph.size(); ++v) count += graph.degree(v) > 0 ? 1 : 0;
  return count;
}

/// Returns the number of different vertices that are corners of simplices.
Index corner_vertices(SimplicesRef simplices, Index vertices) {
  std::vector<bool> seen(static_cast<std::size_t>(vertices), false);
  for (const Index v : simplices.vertices) seen[v] = true;
  return static_cast<Index>(std::count(seen.begin(), seen.end(), true));
}

/// Returns all ways to choose `dimension` of the numbers 1 … k. These are offsets of a simplex's corners from
/// its first corner.
std::vector<std::array<Index, 4>> stencils(int dimension, Index k) {
  std::vector<std::array<Index, 4>> result;
  std::array<Index, 4> offsets{0, 1, 2, 3};
  for (;;) {
    result.push_back(offsets);
    int a = dimension;
    while (a > 0 && offsets[a] == k - (dimension - a)) --a;
    if (a == 0) return result;
    ++offsets[a];
    for (int b = a + 1; b <= dimension; ++b) offsets[b] = offsets[b - 1] + 1;
  }
}

/// Returns `count` simplices of that dimension, each within k + 1 consecutive vertices, spread evenly over
/// the first `corners` vertices.
Cells streamed_simplices(int dimension, Offset count, Index corners, Index k) {
  constexpr std::array kShape{Shape::vertex, Shape::line, Shape::triangle, Shape::tetrahedron};
  Cells cells;
  if (dimension == 0) return cells;
  const auto ways = stencils(dimension, k);
  const Offset starts = std::max<Offset>(1, Offset{corners} - k);
  cells.reserve(count, count * (dimension + 1));
  std::array<Index, 4> vertices{};
  for (Offset s = 0; s < count; ++s) {
    const std::array<Index, 4>& offsets = ways[s % static_cast<Offset>(ways.size())];
    for (int a = 0; a <= dimension; ++a) {
      vertices[a] = static_cast<Index>(std::min<Offset>(starts * s / count + offsets[a], corners - 1));
    }
    cells.push_back(kShape[dimension], std::span(vertices).first(dimension + 1));
  }
  return cells;
}

/// Returns the reaches that the simplices need.
Reaches needed(const Cells& cells, Index vertices) {
  Reaches reaches(static_cast<std::size_t>(vertices), 0);
  for (Index c = 0; c < cells.size(); ++c) {
    for (const Index v : cells[c]) reaches[v] = std::max(reaches[v], cells[c].back() - v);
  }
  return reaches;
}

/// Raises the reaches of the first `joined` vertices level by level, until there are `edges` edges in all. If
/// the last level needs fewer edges than it has vertices, the edges are spread evenly over the vertices.
void fill(Reaches& reaches, Index joined, Offset edges) {
  Offset missing = edges;
  for (const Index reach : reaches) missing -= reach;
  for (Index level = 1; missing > 0 && level < joined; ++level) {
    Offset below = 0;
    for (Index v = 0; v + level < joined; ++v) below += reaches[v] < level ? 1 : 0;
    const Offset raised = std::min(missing, below);
    Offset place = 0;
    for (Index v = 0; v + level < joined; ++v) {
      if (reaches[v] >= level) continue;
      // chooses `raised` of the `below` places, evenly spread: the places where ⌊place · raised / below⌋
      // increases
      if ((place + 1) * raised / below > place * raised / below) reaches[v] = level;
      ++place;
    }
    missing -= raised;
  }
}

CsrGraph joined_to_next(const Reaches& reaches) {
  const Index n = index_size(reaches);
  Index widest = 0;
  for (const Index reach : reaches) widest = std::max(widest, reach);
  CsrGraph graph;
  graph.offsets.reserve(reaches.size() + 1);
  for (Index v = 0; v < n; ++v) {
    for (Index u = std::max<Index>(0, v - widest); u < v; ++u) {
      if (u + reaches[u] >= v) graph.neighbours.push_back(u);
    }
    for (Index u = v + 1; u <= v + reaches[v]; ++u) graph.neighbours.push_back(u);
    graph.offsets.push_back(static_cast<Offset>(graph.neighbours.size()));
  }
  return graph;
}

/// Returns points: each is about 1 from the next, and no four consecutive ones lie in a plane.
std::vector<Point> helix(Index n) {
  std::vector<Point> points(static_cast<std::size_t>(n));
  for (Index v = 0; v < n; ++v) points[v] = {std::cos(1.0 * v), std::sin(1.0 * v), 0.25 * v};
  return points;
}

}  // namespace

Band ideal_band(SimplicesRef simplices, const CsrGraph& graph) {
  const Index n = graph.size();
  const int d = simplices.dimension;
  const Index corners = corner_vertices(simplices, n);
  Band band;
  band.mesh.points = helix(n);
  const Index joined = joined_vertices(graph);
  // at most as many edges per vertex as in a lattice that is cut into simplices; `fill` adds further edges
  const auto per_vertex = static_cast<Index>(graph.edge_count() / std::max<Index>(1, joined));
  const Index k = std::clamp<Index>(per_vertex, d, std::max<Index>(d, (Index{1} << d) - 1));
  band.mesh.cells = streamed_simplices(d, d == 0 ? 0 : simplices.size(), corners, k);
  Reaches reaches = needed(band.mesh.cells, n);
  fill(reaches, joined, graph.edge_count());
  band.graph = joined_to_next(reaches);
  return band;
}

EntryPattern ideal_pattern(const EntryPattern& pattern) {
  const Index n = pattern.rows();
  EntryPattern band;
  band.columns.reserve(pattern.columns.size());
  for (Index row = 0; row < n; ++row) {
    const Offset end = pattern.entries() * (row + 1) / n;
    const auto length = static_cast<Index>(end - band.entries());
    const Index first = std::clamp<Index>(row - length / 2, 0, n - length);
    for (Index k = 0; k < length; ++k) band.columns.push_back(first + k);
    band.starts.push_back(end);
  }
  return band;
}

}  // namespace meshorder
