// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "graph/csr_graph.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Elements and the vertices that each joins: element e has `vertices[offsets[e]] … vertices[offsets[e + 1] −
/// 1]`.
struct Incidence {
  Index vertex_count = 0;
  std::vector<Offset> offsets{0};  ///< elements + 1
  std::vector<Index> vertices;

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] std::span<const Index> operator[](Index element) const {
    return {vertices.data() + offsets[element], vertices.data() + offsets[element + 1]};
  }
};

/// The elements at each vertex, rising: the incidence read the other way. O(entries).
Incidence transposed(const Incidence& incidence);

/// Joins any two vertices of a common element: the vertex graph of a mesh (the paper, section 3).
/// Repeated vertices of an element make no loop. O(sum of element sizes squared).
CsrGraph vertex_graph(const Incidence& elements);

/// Joins any two elements that share a vertex: the dual graph of the paper, section 4.1. This is
/// `vertex_graph(transposed(elements))`, about 50 neighbours for an element of a tetrahedral mesh.
CsrGraph dual_graph_by_vertex(const Incidence& elements);

}  // namespace meshorder
