// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"
#include "distributed/order/order.hpp"
#include <meshorder/view.hpp>

#include <vector>

namespace meshorder::distributed {

/// A mesh as the ranks of a running solver have distributed it.
struct OwnedMesh {
  Layout vertices;            ///< the owners of the vertices
  std::vector<Point> points;  ///< coordinates of this rank's vertices; or empty on all ranks
  Rows cells;                 ///< numbers of the vertices of this rank's elements
};

/// New numbers of a rank's vertices, and the new order of the rank's elements.
struct OwnedOrder {
  std::vector<GlobalIndex> new_numbers;  ///< new number of each vertex of this rank, within the rank's range
  std::vector<GlobalIndex> cells;        ///< indices of this rank's elements in their new order
};

/// Orders the vertices of every rank among themselves, and the elements of each rank by `lexmax`. Every rank
/// has to call it. O(sum of element sizes squared · log degree), plus the cost of the method.
///
/// @param mesh     an element may be on several ranks
/// @param options  only `vertices`, `interface_place` and `order` are used
/// @throws SharedError for a method that does not exist or needs coordinates that are missing, and if a rank
///         fails
[[nodiscard]] OwnedOrder order_owned(const Communicator& communicator, const OwnedMesh& mesh,
                                     const DistributedOptions& options);

/// Parts of a mesh, and new numbers of its vertices, contiguous by part.
struct OwnedParts {
  std::vector<GlobalIndex> new_numbers;  ///< new number of each vertex of this rank
  std::vector<GlobalIndex> starts;       ///< first new number of each part, then the end of the last part
  std::vector<GlobalIndex> cells;  ///< part of each element: the part of its last vertex in the new order
};

/// Orders the vertices as `order_slices` does, and finds the part of each element. Every rank has to call it.
///
/// @param mesh  must have coordinates, and each element on one rank only
/// @throws SharedError without coordinates, and as `order_slices`
[[nodiscard]] OwnedParts order_parts_of_owned(const Communicator& communicator, OwnedMesh mesh,
                                              const DistributedOptions& options);

}  // namespace meshorder::distributed
