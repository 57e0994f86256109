// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/facets.hpp"

#include "base/run_scope.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <functional>
#include <numeric>

namespace meshorder {

const std::vector<std::vector<int>>& FacetsOfTypes::operator()(Shape shape, int vertices) {
  const auto type = std::pair(shape, vertices);
  const auto found = by_type_.find(type);
  if (found != by_type_.end()) return found->second;
  return by_type_.emplace(type, facets(shape, vertices)).first->second;
}

std::array<Index, 4> sorted_corners(std::span<const Index> cell, const std::vector<int>& positions) {
  std::array<Index, 4> corners{-1, -1, -1, -1};
  for (std::size_t k = 0; k < positions.size(); ++k) corners[k] = cell[positions[k]];
  std::sort(corners.begin(), corners.end(), std::greater<>());
  return corners;
}

std::vector<ElementFacet> matched_facets(const std::vector<ElementFacet>& facets, Index vertex_count) {
  // bucket by the largest corner, then sort each bucket
  std::vector<Offset> starts(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const ElementFacet& facet : facets) ++starts[facet.corners[0] + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<Offset> next(starts.begin(), starts.end() - 1);
  std::vector<ElementFacet> result(facets.size());
  for (const ElementFacet& facet : facets) result[next[facet.corners[0]]++] = facet;
  for (Index v = 0; v < vertex_count; ++v) {
    poll_in_loop(v);
    std::sort(result.begin() + starts[v], result.begin() + starts[v + 1],
              [](const ElementFacet& a, const ElementFacet& b) {
                return a.corners != b.corners ? a.corners < b.corners : a.element < b.element;
              });
  }
  return result;
}

std::vector<ElementFacet> matched_facets(const CellArrays& cells, const CellSelection& elements) {
  if (cells.shapes.empty() && cells.size() > 0) {
    throw InvalidArgument("cells: facets need the shapes of the cells");
  }
  std::vector<ElementFacet> all;
  FacetsOfTypes facets_of;
  const IncidenceRef vertices = elements.incidence();
  for (Index e = 0; e < elements.size(); ++e) {
    poll_in_loop(e);
    const auto cell = vertices[e];
    for (const std::vector<int>& positions :
         facets_of(cells.shapes[elements.cell(e)], static_cast<int>(cell.size()))) {
      all.push_back({sorted_corners(cell, positions), e});
    }
  }
  return matched_facets(all, cells.vertex_count);
}

namespace {

/// Joins each polyhedron with all elements that share at least three vertices with it.
void join_polyhedra(const CellArrays& cells, const CellSelection& elements, std::vector<Edge>& joins) {
  constexpr int kFaceCorners = 3;
  constexpr std::size_t kMostElements = 1024;
  const auto is_polyhedron = [&](Index e) { return cells.shapes[elements.cell(e)] == Shape::polyhedron; };
  if (std::find(cells.shapes.begin(), cells.shapes.end(), Shape::polyhedron) == cells.shapes.end()) return;
  const IncidenceRef vertices = elements.incidence();
  const Incidence elements_at = transposed(vertices);
  std::vector<int> common(static_cast<std::size_t>(elements.size()), 0);  // shared vertices, by element
  std::vector<Index> near;
  for (Index e = 0; e < elements.size(); ++e) {
    poll_in_loop(e);
    if (!is_polyhedron(e)) continue;
    for (const Index v : vertices[e]) {
      if (elements_at[v].size() > kMostElements) continue;
      for (const Index other : elements_at[v]) {
        if (common[other]++ == 0) near.push_back(other);
      }
    }
    for (const Index other : near) {
      const bool is_first = other > e || !is_polyhedron(other);
      if (other != e && is_first && common[other] >= kFaceCorners) joins.push_back({e, other});
      common[other] = 0;
    }
    near.clear();
  }
}

}  // namespace

CsrGraph joined_by_facet(const CellArrays& cells, const CellSelection& elements) {
  const std::vector<ElementFacet> facets = matched_facets(cells, elements);
  std::vector<Edge> joins;
  join_polyhedra(cells, elements, joins);
  for (std::size_t i = 1; i < facets.size(); ++i) {
    // if more than two elements share a facet, join each to the next, so that they stay together
    if (facets[i - 1].corners == facets[i].corners)
      joins.push_back({facets[i - 1].element, facets[i].element});
  }
  return graph_from_edges(elements.size(), joins);
}

}  // namespace meshorder
