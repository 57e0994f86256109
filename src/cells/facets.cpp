// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/run_scope.hpp"
#include "cells/cell_arrays.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// The corners of a facet, descending, −1 where there are fewer than four, and the element that it bounds.
struct Facet {
  std::array<Index, 4> corners;
  Index element;
};

std::vector<Facet> all_facets(const CellArrays& cells, const CellSelection& elements) {
  if (cells.shapes.empty() && cells.size() > 0) {
    throw InvalidArgument("cells: facets are known only where the shapes of cells are");
  }
  std::vector<Facet> result;
  // the corners' positions are the same for all cells of a type
  std::map<std::pair<Shape, int>, std::vector<std::vector<int>>> by_type;
  const IncidenceRef vertices = elements.incidence();
  for (Index e = 0; e < elements.size(); ++e) {
    poll();
    const auto type = std::pair(cells.shapes[elements.cell(e)], static_cast<int>(vertices[e].size()));
    auto found = by_type.find(type);
    if (found == by_type.end()) found = by_type.emplace(type, facets(type.first, type.second)).first;
    for (const std::vector<int>& positions : found->second) {
      Facet facet{{-1, -1, -1, -1}, e};
      // polygons and strips have facets of two corners; no facet has more than four
      for (std::size_t k = 0; k < positions.size(); ++k) facet.corners[k] = vertices[e][positions[k]];
      std::sort(facet.corners.begin(), facet.corners.end(), std::greater<>());
      result.push_back(facet);
    }
  }
  return result;
}

/// Returns the facets sorted by their largest corner; `starts` receives where each corner's begin.
std::vector<Facet> bucketed(const std::vector<Facet>& all, std::vector<Offset>& starts) {
  for (const Facet& facet : all) ++starts[facet.corners[0] + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Offset> next(starts.begin(), starts.end() - 1);
  std::vector<Facet> result(all.size());
  for (const Facet& facet : all) result[next[facet.corners[0]]++] = facet;
  return result;
}

}  // namespace

CsrGraph joined_by_facet(const CellArrays& cells, const CellSelection& elements) {
  std::vector<Offset> starts(static_cast<std::size_t>(cells.vertex_count) + 1, 0);
  std::vector<Facet> sorted = bucketed(all_facets(cells, elements), starts);
  std::vector<Edge> joins;
  for (Index v = 0; v < cells.vertex_count; ++v) {
    poll();
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
  return graph_from_edges(elements.size(), joins);
}

}  // namespace meshorder
