// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "cells/cell_arrays.hpp"
#include <meshorder/mesh.hpp>

namespace meshorder {

/// Returns the cells of a mesh in the form that the orderings take. Refers to the mesh. O(blocks).
CellArrays cell_arrays(const Mesh& mesh);

/// Returns the graph that joins any two vertices of a common element, or of a piece of it (vertex_joins.hpp).
/// Vertices without elements have no neighbours. O(sum of piece sizes squared · log degree).
CsrGraph vertex_graph(const Mesh& mesh);

/// Returns the graph of elements that share a facet, numbered in the order of cells: a face for volumes, an
/// edge for surfaces, an end for lines. Facets are the same if their corners are, in any order. O(facets ·
/// log facets at a vertex).
CsrGraph facet_graph(const Mesh& mesh);

}  // namespace meshorder
