// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "graph/csr_graph.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Rows of indices in compressed form. For a mesh: the vertices of each element; transposed: the elements at
/// each vertex. Row e is `vertices[offsets[e]] … vertices[offsets[e + 1] − 1]`.
struct Incidence {
  Index vertex_count = 0;
  std::vector<Offset> offsets{0};  ///< elements + 1
  std::vector<Index> vertices;

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] std::span<const Index> operator[](Index element) const {
    return {vertices.data() + offsets[element], vertices.data() + offsets[element + 1]};
  }
};

/// A view of an incidence; does not own the arrays. A copy takes five words.
struct IncidenceRef {
  Index vertex_count = 0;
  std::span<const Offset> offsets;  ///< elements + 1, from 0
  std::span<const Index> vertices;

  IncidenceRef(Index vertices_in_all, std::span<const Offset> row_offsets,
               std::span<const Index> row_vertices)
      : vertex_count(vertices_in_all), offsets(row_offsets), vertices(row_vertices) {}
  IncidenceRef(const Incidence& incidence)  // NOLINT(google-explicit-constructor)
      : IncidenceRef(incidence.vertex_count, incidence.offsets, incidence.vertices) {}

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(offsets.size() - 1); }
  [[nodiscard]] std::span<const Index> operator[](Index element) const {
    return {vertices.data() + offsets[element], vertices.data() + offsets[element + 1]};
  }
};

/// Returns the number of vertices that every element has; 0 if elements differ. O(elements).
Offset common_size(IncidenceRef elements);

/// Returns the elements at each vertex, ascending. O(entries).
Incidence transposed(IncidenceRef incidence);

/// Returns the graph that joins any two vertices of a common element: the vertex graph of a mesh (the paper,
/// section 3). The graph has no loops, even if an element repeats a vertex. Throws TooLarge if elements of
/// more than `kManyJoined` vertices would make a graph beyond the memory limit. O(sum of element sizes
/// squared).
CsrGraph joined_vertices(IncidenceRef elements);

/// Returns the graph that joins any two elements that share a vertex: the dual graph of the paper, section
/// 4.1. Calls `joined_vertices(transposed(elements))`; elements of tetrahedral meshes have about 50
/// neighbours.
CsrGraph joined_by_vertex(IncidenceRef elements);

}  // namespace meshorder
