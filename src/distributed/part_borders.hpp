// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/mesh_parts.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// A facet of a cell at another part.
struct BorderFacet {
  Index part = 0;  ///< the other one
  Index cell = 0;
  int facet = 0;  ///< place in `facets` of the cell's shape

  bool operator==(const BorderFacet&) const = default;
};

/// Finds the facets of volumes and surfaces that cells of two parts have, those with the same corners. Two
/// parts have as many at each other, in the same order: the k-th of one is the k-th of the other. Of a facet
/// of more than two cells each pair is one. O(entries + facets between parts · log of these).
///
/// @return of each part, by the other part
[[nodiscard]] std::vector<std::vector<BorderFacet>> facets_between(const Mesh& mesh, const MeshParts& parts);

}  // namespace meshorder::distributed
