// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/order/balance.hpp"
#include "distributed/order/global_graph.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "distributed/order/partition.hpp"
#include <meshorder/fiedler.hpp>
#include <meshorder/options.hpp>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// Options for ordering a mesh on many ranks.
struct DistributedOptions {
  /// Vertex method within a part: not `auto`, `original` or `scrambled`. With `Partitioner::order` it orders
  /// the whole mesh and must be `fiedler`.
  std::string vertices = "spectral";
  Partitioner partitioner = Partitioner::ptscotch;
  Index parts = 0;  ///< number of parts; 0: one for each rank
  Balance balance = Balance::vertices;
  InterfacePlace interface_place = InterfacePlace::mixed;
  OrderOptions order = {};  ///< seed, tolerance, max_iterations and run
};

/// Throws InvalidArgument for a method that does not exist or has no meaning within parts, and for a negative
/// number of parts.
void check_options(const DistributedOptions& options);

/// Properties of an order, and the time of each stage.
struct DistributedReport {
  Index parts = 0;
  Partitioner partitioner = Partitioner::ptscotch;  ///< the partitioner that made the parts
  std::string partition_reason;  ///< why the requested partitioner was not used; empty if it was
  double imbalance = 1;          ///< largest part / mean part, in the balanced quantity: vertices or cells
  GlobalIndex edges = 0;
  GlobalIndex cut = 0;                   ///< number of edges between parts
  GlobalIndex ghosts = 0;                ///< number of neighbours outside each part, summed over the parts
  std::vector<GlobalIndex> part_starts;  ///< first new number of each part, then the end of the last part
  std::vector<GlobalIndex> interfaces;   ///< for each part, the number of vertices on its interface
  std::vector<FiedlerComponent>
      fiedler;  ///< for `Partitioner::order`: reports on all components, largest first; at the root
  GlobalEdgeSpan before;
  GlobalEdgeSpan after;
  std::vector<std::pair<std::string_view, double>> seconds;  ///< name and time of each stage, in sequence
};

/// A rank's share of the order of a mesh.
struct DistributedOrder {
  std::vector<GlobalIndex> new_vertices;  ///< new number of each vertex of the slice
  std::vector<GlobalIndex> cells;         ///< old numbers of cells in their new order: this rank's range
  DistributedReport report;
};

/// Orders a mesh. Parts joined by edges get nearby ranges of numbers. The method orders the vertices of a
/// part; vertices that no element uses come last, in their old order. Cells are in the order `lexmax`. With
/// `Partitioner::order` the method orders all vertices, and parts are equal ranges of that order. Every rank
/// has to call it.
///
/// @param slice  its arrays are freed as soon as they are no longer needed
/// @throws SharedError for a method that does not exist or has no meaning within parts, for a number of parts
///         that is negative, or above a million and above the number of vertices, for `Partitioner::order`
///         unless the method is `fiedler`, the balance `vertices` and the interfaces are `mixed`; and if a
///         rank fails
/// @note The order depends only on the mesh, the options and the number of ranks; with `Partitioner::hilbert`
///       and a given number of parts, it does not depend on the number of ranks.
[[nodiscard]] DistributedOrder order_slices(const Communicator& communicator, MeshSlice slice,
                                            const DistributedOptions& options);

}  // namespace meshorder::distributed
