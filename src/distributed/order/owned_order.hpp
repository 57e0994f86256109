// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/rows.hpp"
#include "distributed/order/order.hpp"
#include <meshorder/view.hpp>

#include <vector>

namespace meshorder::distributed {

/// A mesh that the ranks of a running solver share.
struct OwnedMesh {
  Layout vertices;            ///< who owns which
  std::vector<Point> points;  ///< of the own vertices; or none, on all ranks
  Rows cells;                 ///< numbers of the vertices of this rank's elements
};

/// Order of what a rank has.
struct OwnedOrder {
  std::vector<GlobalIndex> new_numbers;  ///< of each own vertex, within the rank's range
  std::vector<GlobalIndex> cells;        ///< places of this rank's elements in their new order
};

/// Orders the vertices of every rank among themselves, and the elements of each by `lexmax`. Every rank has
/// to call it. O(sum of element sizes squared · log degree) and what the method costs.
///
/// @param mesh     elements may be on several ranks
/// @param options  of which `vertices` and `order` count
/// @throws SharedError for a method that there is not, or that needs coordinates where there are none, and
///         where a rank fails
[[nodiscard]] OwnedOrder order_owned(const Communicator& communicator, const OwnedMesh& mesh,
                                     const DistributedOptions& options);

/// Parts of a mesh, and the order in which they and their vertices follow each other.
struct OwnedParts {
  std::vector<GlobalIndex> new_numbers;  ///< of each own vertex
  std::vector<GlobalIndex> starts;       ///< first new number of each part, and the end of the last one's
  std::vector<GlobalIndex> cells;        ///< part of each element: that of its last vertex
};

/// Orders the vertices as `order_slices` does. Every rank has to call it.
///
/// @param mesh  with coordinates; each element on one rank
/// @throws SharedError without coordinates, and as `order_slices`
[[nodiscard]] OwnedParts order_parts_of_owned(const Communicator& communicator, OwnedMesh mesh,
                                              const DistributedOptions& options);

}  // namespace meshorder::distributed
