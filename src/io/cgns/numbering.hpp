// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/cgns/cgns.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace meshorder::cgns {

/// The vertices, polygons and cells of a file in the present order of the mesh, and their numbers.
///
/// Polygons that are cells have the order of their cells. The others lie between two cells: if the polyhedra
/// kept their order, these polygons keep their order, else they are sorted by the lower, then by the higher
/// of the two cells. Each position in a section keeps its kind of polygon: a cell, or a polygon between two
/// cells. Polygons are left out if they are not cells and have no cell on either side.
///
/// The sections keep their element numbers if all keep their sizes, else each zone is numbered from 1 on.
class Numbering {
 public:
  /// `metadata` must fit the mesh; its lists and fields may change later. Both arguments must outlive this
  /// object. O(vertices + cells + polygons · log polygons).
  Numbering(const Mesh& mesh, const CgnsMetadata& metadata);

  [[nodiscard]] Index vertex_count(int zone) const;
  /// Returns the vertex at `place` in a zone.
  [[nodiscard]] Index vertex_at(int zone, Index place) const;
  [[nodiscard]] Index number_of_vertex(Index v) const;

  [[nodiscard]] const std::vector<Index>& cells_of(int section) const { return cells_[section]; }
  /// Returns the polygons of a section of polygons, else its cells.
  [[nodiscard]] const std::vector<Index>& elements_of(int section) const;
  [[nodiscard]] std::int64_t first_number(int section) const { return first_numbers_[section]; }
  [[nodiscard]] Index rank_of_cell(Index c) const { return cell_ranks_[c]; }
  /// Returns the position of a polygon in its section, −1 if it is left out.
  [[nodiscard]] Index rank_of_polygon(Index p) const { return polygon_ranks_[p]; }
  [[nodiscard]] std::int64_t number_of_cell(Index c) const;
  [[nodiscard]] std::int64_t number_of_polygon(Index p) const;
  [[nodiscard]] Index polyhedron_of(Index c) const { return polyhedra_[c]; }

  /// Returns the number of cells of the base's dimension in a zone.
  [[nodiscard]] std::int64_t centred_count(int zone) const { return centred_counts_[zone]; }
  /// Returns whether all sections have as many elements as in the file that was read.
  [[nodiscard]] bool is_whole() const noexcept { return is_whole_; }
  /// Returns the vertices or cells that have the values of a field, in the order of the values.
  [[nodiscard]] std::vector<Index> rows_of(const Field& field) const;

 private:
  void place_vertices();
  void place_polygons();
  void order_polygons(int section, const std::vector<std::pair<Index, Index>>& sides, bool are_moved);
  void place_cells();

  const Mesh& mesh_;
  const CgnsMetadata& metadata_;
  std::vector<std::vector<Index>> vertices_;  ///< vertices of each zone; empty if there is only one zone
  std::vector<Index> vertex_numbers_;         ///< from 1 in each zone; empty if there is only one zone
  std::vector<std::vector<Index>> polygons_;  ///< polygons of each section
  std::vector<Index> polygon_ranks_;
  std::vector<std::vector<Index>> cells_;  ///< cells of each section
  std::vector<Index> cell_ranks_;
  std::vector<Index> polyhedra_;             ///< polyhedron of each cell; −1: the cell is not a polyhedron
  std::vector<std::int64_t> first_numbers_;  ///< first element number of each section
  std::vector<std::int64_t> centred_counts_;
  bool is_whole_ = true;
};

/// Adds nodes to `metadata` for the arrays that have no field in it and the sets that have no list in it.
/// Notes the arrays and sets that CGNS cannot hold.
void add_missing(const Mesh& mesh, CgnsMetadata& metadata, const Numbering& numbering, Notes& notes);

/// Fills in the values of a node that has a field, in the present order of the mesh.
void fill(Node& node, const Mesh& mesh, const CgnsMetadata& metadata, const Numbering& numbering);

}  // namespace meshorder::cgns
