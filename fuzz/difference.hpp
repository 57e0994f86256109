// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>

#include <cstdint>
#include <string>

namespace meshorder::fuzz {

/// The parts of two meshes that are compared.
enum class Extent : std::uint8_t {
  all,               ///< points, cells, data, sets, ids and blocks
  points_and_cells,  ///< coordinates may differ by 10⁻⁶ of their size: some formats round them
  corners,           ///< the points of the cells' vertices
  pairs,             ///< the vertices of each cell; vertices and cells may be in any order
};

/// Returns the first difference between two meshes in words; an empty text if the meshes are equal. Two
/// values are equal if their bits are equal or if both are NaN. Rows of partial arrays and members of sets
/// may have any order. O(size of the meshes · log members).
std::string difference(const Mesh& found, const Mesh& expected, Extent extent);

/// Returns the first difference between cells, as `difference` does; cell c of `expected` is cell
/// `places.old_to_new()[c]` of `found`.
std::string difference_of_cells(const Cells& found, const Cells& expected, const Permutation& places);

}  // namespace meshorder::fuzz
