// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <cstdint>
#include <vector>

namespace meshorder::test {

/// `copies` disjoint cells of one type, with an int label and a double array on vertices and on cells
/// ("label", "temperature", "stress" of 3 components), and a set of each kind ("fixed", "part"). Irregular
/// coordinates reveal mix-ups.
Mesh cells_of_type(Shape shape, int vertices_per_cell, Index copies);

/// Separate triangles, as many as `triangles`, and an edge of the first one, without data and sets.
Mesh triangles_and_line(Index triangles);

/// A row of `n` unit cubes cut into six tetrahedra each, sharing vertices; data and sets as in
/// `cells_of_type`.
Mesh tetrahedral_bar(Index n);

/// Tetrahedra, hexahedra, wedges, pyramids, triangles, quads, lines and vertices in one mesh, interleaved,
/// linear and quadratic; data and sets as in `cells_of_type`.
Mesh mixed_mesh();

/// Types of cells, as (shape, vertices per cell).
using CellTypes = std::vector<std::pair<Shape, int>>;

/// The types that a format must support: all linear types; all second-order types; both, followed by `more`.
CellTypes linear_types();
CellTypes quadratic_types();
CellTypes common_types(const CellTypes& more = {});

/// A seeded random permutation of 0 … n−1.
Permutation shuffled(Index n, std::uint64_t seed);

/// A seeded random permutation of the mesh's cells that keeps blocks and dimensions.
Permutation shuffled_cells(const Mesh& mesh, std::uint64_t seed);

/// The mesh with the rows of partial arrays and the members of sets in ascending order.
Mesh sorted_members(Mesh mesh);

/// EXPECTs that two meshes are the same: points, cells, data, sets, ids and blocks, but not
/// `format_metadata`.
void expect_same(const Mesh& actual, const Mesh& expected);

}  // namespace meshorder::test
