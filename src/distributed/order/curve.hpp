// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// The vertices of a mesh numbered along Hilbert's curve, ties by their numbers in the file; after them
/// those that nothing uses, in the order of the file. The numbers are the same on any number of ranks.
struct Curve {
  Layout layout;                            ///< of the numbers of used vertices: equal shares
  std::vector<GlobalIndex> number_of;       ///< of each vertex of the slice: its number
  std::vector<GlobalIndex> number_in_file;  ///< of each own number
  std::vector<Point> points;                ///< of each own number
};

/// Numbers the vertices of a mesh. Every rank has to call it. O(n log n) for n vertices of a rank.
///
/// @param vertices  who has which vertices
/// @param points    of the own ones
/// @param used      whether each of them is to be ordered
/// @throws as `Communicator::exchange`
[[nodiscard]] Curve along_hilbert_curve(const Communicator& communicator, const Layout& vertices,
                                        const std::vector<Point>& points, const std::vector<char>& used);

}  // namespace meshorder::distributed
