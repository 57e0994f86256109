// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "cells/cell_arrays.hpp"

#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {

/// A facet of an element: a face of a volume, an edge of a surface, an end of a line.
struct ElementFacet {
  std::array<Index, 4> corners;  ///< descending; −1 in places without a corner
  Index element;
};

/// Caches the facets of each type of cells.
class FacetsOfTypes {
 public:
  const std::vector<std::vector<int>>& operator()(Shape shape, int vertices);

 private:
  std::map<std::pair<Shape, int>, std::vector<std::vector<int>>> by_type_;
};

/// Returns the corners of a cell at these positions (at most four), in descending order; −1 in the remaining
/// places.
std::array<Index, 4> sorted_corners(std::span<const Index> cell, const std::vector<int>& positions);

/// Returns the facets, sorted so that those with the same corners are adjacent and ascend by element.
/// `vertex_count` exceeds every corner. O(facets · log facets at a vertex).
std::vector<ElementFacet> matched_facets(const std::vector<ElementFacet>& facets, Index vertex_count);

/// Returns the facets of elements, sorted as above.
///
/// @throws InvalidArgument if the shapes of cells are not known
std::vector<ElementFacet> matched_facets(const CellArrays& cells, const CellSelection& elements);

/// Returns the graph that joins elements, numbered as in `elements`, if they share a facet: volumes a face,
/// surfaces an edge, lines an end. Two facets are the same if they have the same corners, in any order. If
/// more than two elements share a facet, each is joined to the next. A polyhedron, whose faces are not known,
/// is joined to the elements that share three vertices with it; vertices of over 1,024 elements do not count.
/// O(facets · log facets at a vertex), for polyhedra O(Σ elements at their vertices).
///
/// @throws InvalidArgument if the shapes of cells are not known
CsrGraph joined_by_facet(const CellArrays& cells, const CellSelection& elements);

}  // namespace meshorder
