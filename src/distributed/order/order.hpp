// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/order/balance.hpp"
#include "distributed/order/interface_place.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "distributed/order/partition.hpp"
#include "distributed/order/spans.hpp"
#include <meshorder/fiedler.hpp>
#include <meshorder/options.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// How a mesh is ordered by many ranks.
struct DistributedOptions {
  /// Vertex method inside a part, not `auto`, `original` or `scrambled`. With `Partitioner::order` that of
  /// the whole mesh, which is `fiedler`.
  std::string vertices = "spectral";
  Partitioner partitioner = Partitioner::ptscotch;
  Index parts = 0;  ///< 0: one for each rank
  Balance balance = Balance::vertices;
  InterfacePlace interface_place = InterfacePlace::mixed;
  OrderOptions order = {};  ///< seed, tolerance, max_iterations and run
};

/// Throws InvalidArgument for a method that there is not or that has no meaning within parts, and for fewer
/// than no parts.
void check_options(const DistributedOptions& options);

/// What is reported of an order.
struct DistributedReport {
  Index parts = 0;
  Partitioner partitioner = Partitioner::ptscotch;  ///< that made the parts
  std::string partition_reason;                     ///< why that is not the one asked for; else empty
  double imbalance = 1;  ///< the largest part relative to the mean, in what is balanced: vertices or cells
  GlobalIndex edges = 0;
  GlobalIndex cut = 0;                   ///< edges between parts
  GlobalIndex ghosts = 0;                ///< vertices that parts need of others, summed over the parts
  std::vector<GlobalIndex> part_starts;  ///< first new number of each part, and the end of the last one's
  std::vector<GlobalIndex> interfaces;   ///< of each part: vertices that share an element with other parts'
  std::vector<FiedlerComponent>
      fiedler;  ///< `Partitioner::order`: of all components, largest first; at the root
  GlobalEdgeSpan before;
  GlobalEdgeSpan after;
  std::vector<std::pair<std::string_view, double>> seconds;  ///< of each stage, in their order
};

/// A rank's share of the order of a mesh.
struct DistributedOrder {
  std::vector<GlobalIndex> new_vertices;  ///< new number of each vertex of the slice
  std::vector<GlobalIndex> cells;  ///< numbers of cells in their new order, which goes on on the next rank
  DistributedReport report;
};

/// Orders a mesh: parts, numbered so that those that touch are near each other; the vertices of a part by the
/// method, those that no element uses after all others, in their old order; cells by `lexmax`. With
/// `Partitioner::order` the method orders all vertices, and parts are equal ranges of that. Every rank has to
/// call it.
///
/// @param slice  taken: what is done with is given up
/// @throws SharedError for a method that there is not or that has no meaning within parts, for fewer than one
///         part, where `Partitioner::order` goes with another method than `fiedler` or with a balance or
///         place of interfaces that equal ranges cannot have, and where a rank fails
/// @note The same order for the same mesh, options and number of ranks; with `Partitioner::hilbert` and the
///       number of parts given, on any number of ranks and threads.
[[nodiscard]] DistributedOrder order_slices(const Communicator& communicator, MeshSlice slice,
                                            const DistributedOptions& options);

}  // namespace meshorder::distributed
