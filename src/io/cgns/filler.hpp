// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/cgns/cgns.hpp"
#include "io/cgns/polyhedra_order.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::cgns {

/// Fills the nodes of a file with their values, in the present order of the mesh.
class Filler {
 public:
  Filler(const Mesh& mesh, const CgnsMetadata& metadata);
  /// Returns whether the vertices are in the order of their zones.
  [[nodiscard]] bool has_vertices_in_order() const;
  void fill(Node& node);
  /// Returns whether a field has nothing to write: an empty section or list, or an array that is gone or no
  /// longer fits.
  [[nodiscard]] bool is_gone(const Field& field) const;

 private:
  void place_vertices();
  void place_cells();
  /// Returns the number of elements of a section in the file, including polygons that are not cells.
  [[nodiscard]] Index element_count(int s) const;
  [[nodiscard]] Index vertex_count(int zone) const;
  [[nodiscard]] Index vertex_at(int zone, Index number) const;
  [[nodiscard]] Index number_of_vertex(Index v) const;
  [[nodiscard]] std::int64_t number_of_cell(Index c) const;

  template <class Number>
  static void put(Node& node, std::string type, std::vector<std::int64_t> dimensions,
                  const std::vector<Number>& numbers);
  /// Puts whole numbers into a node, as I8 if `type` has 64 bits or a number does not fit 32 bits, else as
  /// I4.
  static void put_whole(Node& node, const std::string& type, std::vector<std::int64_t> dimensions,
                        const std::vector<std::int64_t>& numbers);

  void fill_size(Node& node, int z) const;
  template <class Number>
  void put_coordinate(Node& node, const std::string& type, const Field& field) const;
  void fill_coordinate(Node& node, const Field& field) const;
  template <class Number>
  void put_connectivity(Node& node, int s, const std::string& type) const;
  void fill_connectivity(Node& node, int s) const;
  [[nodiscard]] std::vector<std::int64_t> offsets_of(int s) const;
  void fill_offsets(Node& node, int s) const;

  /// Returns the vertices or cells that have values in a node, in the order of the values.
  [[nodiscard]] std::vector<Index> rows_of(const Field& field) const;
  template <class Number, class Old>
  static void put_values(Node& node, const std::string& type, const std::vector<Old>& values,
                         const std::vector<Index>& rows, const std::vector<Index>& table, const Field& field,
                         Index components);
  void fill_values(Node& node, const Field& field) const;
  void fill_list(Node& node, const PointList& list) const;
  void fill_parents(Node& node, const Parents& parents) const;

  const Mesh& mesh_;
  const CgnsMetadata& metadata_;
  PolyhedraOrder polyhedra_;
  std::vector<std::vector<Index>> vertices_of_zone_;
  /// Numbers of the vertices in their zones, from 1; empty if there is only one zone.
  std::vector<Index> number_of_vertex_;
  std::vector<std::vector<Index>> cells_of_section_;
  std::vector<Index> rank_of_cell_;
  std::vector<std::int64_t> first_numbers_;
  std::vector<std::int64_t> counts_;  ///< number of cells of the base's dimension, by zone
  bool is_whole_ = true;
};

}  // namespace meshorder::cgns
