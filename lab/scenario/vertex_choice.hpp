// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/scenario.hpp"
#include <meshorder/mesh.hpp>

#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// An axis-aligned bounding box.
struct BoundingBox {
  Point low{}, high{};

  [[nodiscard]] double longest_side() const;
};

/// Returns the bounding box of `points[v]` for all v in `vertices`, which must not be empty. O(vertices).
BoundingBox bounding_box(std::span<const Point> points, std::span<const Index> vertices);

/// Returns the vertices that `choice` describes among the `candidates`, ascending. The candidates are the
/// vertices of the simulation, also ascending. The result does not depend on the numbering: of several
/// nearest points, the one with the smallest coordinates counts (x before y before z), and all vertices at
/// that point are chosen. Relative coordinates refer to the candidates' bounding box; along a side of length
/// 0 they are 0.
///
/// Throws Error, which names `file` and the choice's path in it, for an unknown set or label (and lists the
/// known ones), or if no vertex is found. O(size of the mesh).
std::vector<Index> choose_vertices(const Mesh& mesh, std::span<const Index> candidates,
                                   const VertexChoice& choice, const std::string& file);

}  // namespace meshorder
