// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "cells/vertex_joins.hpp"

#include "graph/join_limit.hpp"

namespace meshorder {
namespace {

/// Returns the pieces of all elements (see for_each_piece).
Incidence pieces_of(const CellArrays& cells, const CellSelection& elements) {
  Incidence pieces;
  pieces.vertex_count = cells.vertex_count;
  const IncidenceRef whole = elements.incidence();
  for (Index e = 0; e < elements.size(); ++e) {
    for_each_piece(cells.shapes[elements.cell(e)], whole[e], [&](std::span<const Index> piece) {
      pieces.vertices.insert(pieces.vertices.end(), piece.begin(), piece.end());
      pieces.offsets.push_back(static_cast<Offset>(pieces.vertices.size()));
    });
  }
  return pieces;
}

}  // namespace

bool is_joined_by_pieces(Shape shape, std::size_t vertices) {
  switch (shape) {
    case Shape::polyline:
      return vertices > 2;
    case Shape::triangle_strip:
      return vertices > 3;
    case Shape::poly_vertex:
      return true;
    case Shape::polygon:
    case Shape::polyhedron:
      return vertices > kManyJoined;
    default:
      return false;
  }
}

CsrGraph vertex_graph(const CellArrays& cells) {
  const CellSelection elements = CellSelection::elements(cells);
  const IncidenceRef whole = elements.incidence();
  bool by_pieces = false;
  for (Index e = 0; e < elements.size() && !cells.shapes.empty(); ++e) {
    by_pieces = by_pieces || is_joined_by_pieces(cells.shapes[elements.cell(e)], whole[e].size());
  }
  if (!by_pieces) return joined_vertices(whole, {.number_of = [&](Index e) { return elements.cell(e); }});
  return joined_vertices(pieces_of(cells, elements), {.number_of = [&](Index piece) {
                           Index e = -1;
                           while (piece >= 0) {
                             const auto count = [&](std::span<const Index>) { --piece; };
                             ++e;
                             for_each_piece(cells.shapes[elements.cell(e)], whole[e], count);
                           }
                           return elements.cell(e);
                         }});
}

}  // namespace meshorder
