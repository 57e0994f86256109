// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder::distributed {

/// The numbers of a mesh's vertices along a Hilbert curve. Vertices at the same point of the curve are
/// sorted by their numbers in the file; unused vertices come last, in the order of the file. The numbers are
/// the same on any number of ranks.
struct Curve {
  Layout layout;                            ///< the owners of the numbers of used vertices, in equal shares
  std::vector<GlobalIndex> number_of;       ///< curve number of each vertex of the slice
  std::vector<GlobalIndex> number_in_file;  ///< number in the file of each curve number that this rank owns
  std::vector<Point> points;                ///< point of each curve number that this rank owns
};

/// Numbers the vertices of a mesh. Every rank has to call it. O(n log n) for n vertices of a rank.
///
/// @param vertices  the owners of the vertices
/// @param points    coordinates of this rank's vertices
/// @param used      whether an element uses each vertex of this rank
/// @throws as `Communicator::exchange`
[[nodiscard]] Curve along_hilbert_curve(const Communicator& communicator, const Layout& vertices,
                                        const std::vector<Point>& points, const std::vector<char>& used);

}  // namespace meshorder::distributed
