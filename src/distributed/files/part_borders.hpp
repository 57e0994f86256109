// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/files/mesh_parts.hpp"
#include "distributed/files/mesh_share.hpp"
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
/// of more than two cells each pair is one. Every rank has to call it. O(entries + facets between parts · log
/// of these).
///
/// @param mesh     what this rank has of the mesh, as in `MeshShare`
/// @param numbers  of its vertices and cells
/// @param parts    of that
/// @return of each part, of which this rank knows its own, by the other part
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<std::vector<BorderFacet>> facets_between(const Communicator& communicator,
                                                                   const Mesh& mesh,
                                                                   const ShareNumbers& numbers,
                                                                   const MeshParts& parts);

}  // namespace meshorder::distributed
