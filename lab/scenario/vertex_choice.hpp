// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/scenario.hpp"
#include "mesh/mesh.hpp"

#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// The smallest box along the axes that holds some points.
struct BoundingBox {
  Point low{}, high{};

  /// The length of its longest side.
  [[nodiscard]] double longest_side() const;
};

/// The box of `points[v]` for all v of `vertices`, of which there must be one. O(vertices).
BoundingBox bounding_box(std::span<const Point> points, std::span<const Index> vertices);

/// The vertices that are meant, rising, of the `candidates` (rising: those that take part in the simulation).
/// The same ones however the mesh is numbered: of several nearest ones the one with the smallest coordinates
/// counts, x before y before z, and all that lie at that very point. Relative coordinates are those in the
/// candidates' bounding box, a side without length counting as 0.
///
/// Throws Error, which names `file` and the choice's place in it, for a set or label that the mesh has not
/// (and lists those it has), and when no vertex is meant. O(size of the mesh).
std::vector<Index> choose_vertices(const Mesh& mesh, std::span<const Index> candidates,
                                   const VertexChoice& choice, const std::string& file);

}  // namespace meshorder
