// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/cgns/cgns.hpp"

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace meshorder::cgns {

/// Returns whether the polygons and polyhedra of the metadata are cells of the mesh with the same vertices.
/// O(size of the mesh).
bool polyhedra_fit(const Mesh& mesh, const CgnsMetadata& metadata);

/// The polygons and polyhedra of a file in their new order.
///
/// Polygons that are cells have the order of their cells. The others lie between two cells: if the polyhedra
/// kept their order, these polygons keep theirs, else they are sorted by the lower, then by the higher cell.
/// The kind of polygon at each place in a section does not change: a polygon that is a cell, or a polygon
/// between two cells. Polygons are left out if they are not cells and have no cell on either side.
class PolyhedraOrder {
 public:
  /// `metadata` must outlive this object and fit its mesh, see `polyhedra_fit`. O(polygons · log polygons).
  explicit PolyhedraOrder(const CgnsMetadata& metadata);

  /// Returns the polygons of a section in their new order.
  [[nodiscard]] const std::vector<Index>& polygons_of(int section) const { return polygons_[section]; }
  /// Returns the new place of a polygon in its section, −1 if it is left out.
  [[nodiscard]] Index rank_of(Index polygon) const { return ranks_[polygon]; }

  /// Returns ElementConnectivity of a section of polygons. `number_of` returns the number of a vertex.
  [[nodiscard]] std::vector<std::int64_t> corner_numbers(
      int section, const std::function<std::int64_t(Index)>& number_of) const;
  /// Returns ElementConnectivity of a section of polyhedra. `cells`: the cells of the section;
  /// `first_numbers`: the number of the first element of each section.
  [[nodiscard]] std::vector<std::int64_t> face_numbers(int section, const std::vector<Index>& cells,
                                                       const std::vector<std::int64_t>& first_numbers) const;
  /// Returns ElementStartOffset of a section of polygons or polyhedra. `cells`: the polyhedra's cells.
  [[nodiscard]] std::vector<std::int64_t> offsets(int section, const std::vector<Index>& cells) const;

 private:
  void order_section(int section, const std::vector<std::pair<Index, Index>>& sides, bool are_moved);
  [[nodiscard]] int section_of(Index polygon) const;

  const CgnsMetadata& metadata_;
  std::vector<std::vector<Index>> polygons_;  ///< by section
  std::vector<Index> ranks_;                  ///< by polygon
  std::vector<Index> polyhedron_of_cell_;     ///< −1: the cell is not a polyhedron
};

}  // namespace meshorder::cgns
