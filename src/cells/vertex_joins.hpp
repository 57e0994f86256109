// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "cells/cell_arrays.hpp"
#include "graph/csr_graph.hpp"
#include "graph/incidence.hpp"
#include <meshorder/shape.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace meshorder {

/// Returns whether a cell joins its vertices by pieces, instead of each to all others. A polyline joins
/// consecutive points, a triangle strip joins the points of each of its triangles, a point cloud joins no
/// points. A polygon or polyhedron of more than 64 vertices is cut as the kernels cut it
/// (`cut_into_simplices`), because the number of all pairs is quadratic in the vertices. O(1).
bool is_joined_by_pieces(Shape shape, std::size_t vertices);

/// Calls `call` with the vertices of each piece of a cell; all vertices of a piece are joined to each other.
/// A cell that is not joined by pieces is one piece. O(vertices).
template <class Number, class Call>
void for_each_piece(Shape shape, std::span<const Number> cell, const Call& call) {
  if (!is_joined_by_pieces(shape, cell.size())) return call(cell);
  const auto windows = [&](std::size_t width) {
    for (std::size_t i = 0; i + width <= cell.size(); ++i) call(cell.subspan(i, width));
  };
  if (shape == Shape::poly_vertex) return windows(1);
  if (shape == Shape::polyline) return windows(2);
  if (shape == Shape::triangle_strip) return windows(3);
  if (shape == Shape::polyhedron) return windows(4);
  if (shape != Shape::polygon) return;
  for (std::size_t i = 2; i < cell.size(); ++i) {
    const std::array<Number, 3> triangle{cell[0], cell[i - 1], cell[i]};
    call(std::span<const Number>(triangle));
  }
}

/// Returns the graph that joins any two vertices of an element (the paper, section 3), or of a piece of the
/// element if `is_joined_by_pieces`. Cells of lower dimension join nothing. O(sum of piece sizes squared ·
/// log degree).
///
/// @throws TooLarge as `joined_vertices`
CsrGraph vertex_graph(const CellArrays& cells);

}  // namespace meshorder
