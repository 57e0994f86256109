// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/part_borders.hpp"

#include "cells/facets.hpp"

#include <algorithm>
#include <span>

namespace meshorder::distributed {
namespace {

/// Returns whether another part has all of these vertices.
bool is_shared(const MeshParts& parts, std::span<const Index> cell, const std::vector<int>& positions) {
  const auto first = parts.parts_with(cell[positions.front()]);
  if (first.size() < 2) return false;
  const auto has_all = [&](Index part) {
    return std::all_of(positions.begin(), positions.end(), [&](int position) {
      const auto with = parts.parts_with(cell[position]);
      return std::binary_search(with.begin(), with.end(), part);
    });
  };
  return std::count_if(first.begin(), first.end(), has_all) > 1;
}

/// Returns the facets that more than one part may have, matched.
std::vector<ElementFacet> candidates(const Mesh& mesh, const MeshParts& parts, FacetsOfTypes& facets_of) {
  std::vector<ElementFacet> found;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto cell = mesh.cells[c];
    for (const std::vector<int>& positions : facets_of(mesh.cells.shapes[c], mesh.cells.vertex_count(c))) {
      if (positions.size() > 1 && is_shared(parts, cell, positions))
        found.push_back({sorted_corners(cell, positions), c});
    }
  }
  return matched_facets(found, mesh.vertex_count());
}

/// Returns which facet of its cell one is.
int place_of(const ElementFacet& facet, const Mesh& mesh, FacetsOfTypes& facets_of) {
  const auto cell = mesh.cells[facet.element];
  const auto& all = facets_of(mesh.cells.shapes[facet.element], static_cast<int>(cell.size()));
  const auto found = std::find_if(all.begin(), all.end(), [&](const std::vector<int>& positions) {
    return sorted_corners(cell, positions) == facet.corners;
  });
  return static_cast<int>(found - all.begin());
}

}  // namespace

std::vector<std::vector<BorderFacet>> facets_between(const Mesh& mesh, const MeshParts& parts) {
  FacetsOfTypes facets_of;
  const std::vector<ElementFacet> facets = candidates(mesh, parts, facets_of);
  std::vector<std::vector<BorderFacet>> result(static_cast<std::size_t>(parts.size()));
  const auto add = [&](const ElementFacet& facet, Index other) {
    result[parts.part_with(facet.element)].push_back(
        {other, facet.element, place_of(facet, mesh, facets_of)});
  };
  for (std::size_t begin = 0, end = 0; begin < facets.size(); begin = end) {
    while (end < facets.size() && facets[end].corners == facets[begin].corners) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = i + 1; k < end; ++k) {
        const Index part = parts.part_with(facets[i].element);
        const Index other = parts.part_with(facets[k].element);
        if (part == other) continue;
        // both in one step, so that the two have their facets in one order
        add(facets[i], other);
        add(facets[k], part);
      }
    }
  }
  for (std::vector<BorderFacet>& of_part : result) {
    std::stable_sort(of_part.begin(), of_part.end(),
                     [](const BorderFacet& a, const BorderFacet& b) { return a.part < b.part; });
  }
  return result;
}

}  // namespace meshorder::distributed
