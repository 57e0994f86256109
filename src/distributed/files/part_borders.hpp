// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/files/mesh_parts.hpp"
#include "distributed/files/mesh_share.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// A facet that a cell shares with a cell of another part.
struct BorderFacet {
  Index part = 0;  ///< part of the other cell
  Index cell = 0;
  int facet = 0;  ///< index in `facets` of the cell's shape

  bool operator==(const BorderFacet&) const = default;
};

/// Finds the facets that cells of two parts share: facets of volumes and surfaces with the same corners. The
/// lists of two parts a and b match: the k-th facet in a's list that b shares is also the k-th facet in b's
/// list that a shares. A facet of more than two cells counts once for each pair. Every rank has to call it.
/// O(entries + f log f) time for f facets between parts.
///
/// @param mesh     this rank's share of the mesh, as in `MeshShare`
/// @param numbers  new numbers of the vertices and cells of `mesh`
/// @param parts    parts of `mesh`
/// @return the facets of each part (only of this rank's parts), sorted by the other part
/// @throws as `Communicator::exchange`
[[nodiscard]] std::vector<std::vector<BorderFacet>> facets_between(const Communicator& communicator,
                                                                   const Mesh& mesh,
                                                                   const ShareNumbers& numbers,
                                                                   const MeshParts& parts);

}  // namespace meshorder::distributed
