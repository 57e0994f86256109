// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of CGNS.
//
// Format: "The CFD General Notation System: Standard Interface Data Structures" (SIDS),
// https://cgns.github.io/CGNS_docs_current/sids/. Node orders of elements are those of its section 3.3.
//
// Element sections become blocks of cells, zone by zone, in the order of their element numbers. A boundary
// condition or a ZoneSubRegion_t becomes a set of the same name, "ZONE.NAME" if several have that name. An
// array of a solution keeps its name, or becomes "SOLUTION.NAME" if the values of that name do not fit into
// one array, "NAME step K" if the file assigns the solution to one of several times. Arrays at cell centres
// belong to the cells of the base's dimension. All other nodes are kept as they are.
//
// Polyhedra become tetrahedra, pyramids, wedges or hexahedra if their faces form such a cell, else cells of
// the shape polyhedron. A polygon becomes a cell if it is a face of fewer than two polyhedra, or if a node
// lists it by number. The other polygons lie between two cells and follow the order of these cells.

#include "io/cgns/tree.hpp"
#include "io/format.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::cgns {

// ---- types of elements

inline constexpr int kMixedElements = 20;
inline constexpr int kPolygons = 22;
inline constexpr int kPolyhedra = 23;

struct ElementType {
  int number;  ///< value of ElementType_t
  std::string_view name;
  Shape shape;
  int nodes;
};

/// Returns the element type `number`; null for unknown types, mixed elements, polygons and polyhedra.
const ElementType* element_type(std::int64_t number);
/// Returns the type of cells of this shape, null if there is none.
const ElementType* element_type_of(Shape shape, int nodes);
/// Returns, for each vertex of a cell, the position in the file's element; empty if both orders agree. The
/// permutation is its own inverse.
std::span<const int> file_order(Shape shape, int nodes);

// ---- contents of a file besides the mesh

struct Zone {
  std::string name;
  std::string number_type = "I4";  ///< type of the sizes in the Zone_t node
  std::int64_t cell_count = 0;     ///< number of cells as given in the file, not checked
};

/// A section of elements.
struct Section {
  int zone = 0;
  std::string name = {};
  int type = 0;            ///< number of the element type, `kMixedElements`, `kPolygons` or `kPolyhedra`
  std::int64_t first = 1;  ///< element number of its first element
  Index count = 0;         ///< number of its elements in the file
  std::string range_type = "I4";
  std::string number_type = "I4";
  std::string offset_type = {};  ///< type of ElementStartOffset, empty if the section has none
  Index first_item = 0;          ///< index in `Polyhedra` of the first polygon or polyhedron

  [[nodiscard]] bool is_of_polyhedra() const { return type == kPolygons || type == kPolyhedra; }
};

/// The polygons and polyhedra of all zones, section by section. Reordering the mesh does not change them.
struct Polyhedra {
  std::vector<Offset> corner_starts{0};  ///< start of each polygon in `corners`, then the size of `corners`
  std::vector<Index> corners;            ///< vertices of the polygons, by their positions in the file
  std::vector<Offset> face_starts{0};    ///< start of each polyhedron in `faces`, then the size of `faces`
  /// Faces of polyhedra: ±(1 + index of the polygon), negative if the polygon's normal points inward.
  std::vector<Index> faces;

  [[nodiscard]] Index polygon_count() const { return static_cast<Index>(corner_starts.size() - 1); }
  [[nodiscard]] Index polyhedron_count() const { return static_cast<Index>(face_starts.size() - 1); }
  [[nodiscard]] std::span<const Index> corners_of(Index polygon) const {
    return row(corner_starts, corners, polygon);
  }
  [[nodiscard]] std::span<const Index> faces_of(Index polyhedron) const {
    return row(face_starts, faces, polyhedron);
  }
  /// Returns the polygon of an entry of `faces`.
  static Index polygon_of(Index face) { return (face < 0 ? -face : face) - 1; }

 private:
  static std::span<const Index> row(const std::vector<Offset>& starts, const std::vector<Index>& entries,
                                    Index k) {
    const auto at = static_cast<std::size_t>(k);
    return {entries.data() + starts[at], entries.data() + starts[at + 1]};
  }
};

/// Vertices or cells that a node of the file lists by number.
struct PointList {
  int zone = 0;
  Association association = Association::vertices;
  std::vector<Index> members = {};  ///< positions in the mesh
  std::string set = {};             ///< name of the mesh's set with the same members; empty if there is none
  bool is_range = false;            ///< the file gave only the first and the last number
  std::string number_type = "I4";
  bool is_shortened = false;  ///< whether members were left out or replaced
  bool orders_data = false;   ///< other nodes may have values for the members, in the same order
};

/// The parents of a section's elements: the cells on both sides of each element.
struct Parents {
  int section = 0;
  std::size_t columns = 2;              ///< values per element: 4 in ParentData, else 2
  std::vector<Index> rows = {};         ///< the cell of each row, or the polygon if `of_polygons`
  std::vector<Index> cells = {};        ///< the first column of parents, then the second; −1: no parent
  std::vector<std::int64_t> rest = {};  ///< the values of the other columns, column by column
  bool of_polygons = false;
  bool from_one = false;  ///< parents are counted from 1, not by the element numbers of their section
  std::string number_type = "I4";
};

/// The meaning of a node's values and their place in the mesh.
struct Field {
  enum class Role : std::uint8_t {
    zone_size,
    coordinate,
    range,
    connectivity,
    offsets,
    values,
    list,
    parents
  };
  Role role = Role::values;
  int place = 0;           ///< index of the zone, section, list or parents, by role
  int axis = 0;            ///< axis of a coordinate, from 0
  std::string type = {};   ///< type of values and coordinates in the file
  std::string array = {};  ///< name of the mesh's array
  bool has_left = false;   ///< for values: whether the array no longer fits its fields
  Index component = 0;     ///< component of the array
  Association association = Association::vertices;
  int section = -1;  ///< section whose cells have the values, in order; −1: see `list`
  int list = -1;     ///< list whose members have the values, in order; −1: the whole zone
};

/// The nodes of a file, without the values that the mesh holds, and the fields that describe these values.
struct CgnsMetadata final : FormatMetadata {
  std::shared_ptr<const Tree> tree;
  int cell_dimension = 3;
  bool has_labels = false;  ///< whether sections hold the labels of their cells
  std::vector<Zone> zones;
  std::vector<Section> sections;
  std::vector<PointList> lists;
  std::vector<Parents> parents;
  std::vector<Field> fields;
  std::vector<Index> zone_of_vertex;  ///< empty for one zone
  std::vector<Index> section_of_cell;
  std::shared_ptr<const Polyhedra> polyhedra;  ///< null if there are none
  std::vector<Index> cell_of_polygon;          ///< −1: the polygon is not a cell
  std::vector<Index> cell_of_polyhedron;       ///< −1: the polyhedron was left out
  std::vector<Index> vertex_places;            ///< mesh index of each vertex of the file; empty: same order
  std::vector<std::string> lost;               ///< see `contents`

  /// Returns the index in the mesh of the vertex at `place` in the file.
  [[nodiscard]] Index vertex_at(Index place) const {
    return vertex_places.empty() ? place : vertex_places[static_cast<std::size_t>(place)];
  }

  /// Returns the zone of a vertex or a cell.
  [[nodiscard]] int zone_of(Association association, Index position) const {
    if (association == Association::cells) return sections[section_of_cell[position]].zone;
    return zone_of_vertex.empty() ? 0 : zone_of_vertex[position];
  }

  [[nodiscard]] std::vector<std::string> contents() const override { return lost; }
  [[nodiscard]] std::shared_ptr<const FormatMetadata> moved(std::span<const Index> vertices,
                                                            std::span<const Index> cells) const override;
};

/// `kSectionLabel`: name of the node that holds the label of a section's cells. `kZone`: name of the array
/// that holds the zone of each cell.
inline constexpr std::string_view kSectionLabel = "label";
inline constexpr std::string_view kZone = "zone";
/// Returns the name of the section that `layout_of` makes for cells of a type and label. Readers make no set
/// of a section with this name.
std::string name_of_label(const ElementType& type, std::int64_t label);
/// Name of the node that holds values of a section's cells. Used for cells of lower dimensions: solutions
/// hold only values of cells of the base's dimension.
inline constexpr std::string_view kSectionValues = "CellValues";

/// Makes the nodes of a file for a mesh of another format: one zone, whose sections are runs of cells of one
/// type and one label or the same sets. Sets and arrays are left to `add_missing` (numbering.hpp).
std::shared_ptr<CgnsMetadata> layout_of(const Mesh& mesh);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

}  // namespace meshorder::cgns
