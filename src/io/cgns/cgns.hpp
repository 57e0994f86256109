// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of CGNS.
//
// Format: "The CFD General Notation System: Standard Interface Data Structures" (SIDS),
// https://cgns.github.io/CGNS_docs_current/sids/. Node orders of elements are those of its section 3.3.
//
// In a Mesh, element sections are the blocks of cells, zone after zone and by their numbers. A boundary
// condition or a ZoneSubRegion_t is a set of its name, "ZONE.NAME" where several zones have that name. A
// solution gives arrays of the names that it has, "SOLUTION.NAME" where two have values for the same vertices
// or cells, and "NAME step K" where the file says that it belongs to one of several times. Arrays at cell
// centres belong to the cells of the base's dimension. All other nodes are kept as they are.
//
// Polyhedra are the cells that their faces make: tetrahedra, pyramids, wedges and hexahedra if they can, else
// cells of the shape polyhedron. Of the polygons, those are cells that fewer than two
// polyhedra have and those that a condition or a solution names; the others lie between two cells and follow
// these.

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

/// A type of elements.
struct ElementType {
  int number;  ///< in ElementType_t
  std::string_view name;
  Shape shape;
  int nodes;
};

/// Returns the type of that number, null for an unknown one and for mixed elements, polygons and polyhedra.
const ElementType* element_type(std::int64_t number);
/// Returns the type of cells of this shape, null if there is none.
const ElementType* element_type_of(Shape shape, int nodes);
/// Returns the place in the file of each node of a cell; empty if they are in the order of a Mesh.
std::span<const int> file_order(Shape shape, int nodes);

// ---- what a file has besides the mesh

/// A zone.
struct Zone {
  std::string name;
  std::string number_type = "I4";  ///< of its size
  std::int64_t cell_count = 0;     ///< that it gives, whatever it counts
};

/// A section of elements.
struct Section {
  int zone = 0;
  std::string name;
  int type = 0;            ///< number of the element type, `kMixedElements`, `kPolygons` or `kPolyhedra`
  std::int64_t first = 1;  ///< number of its first element in the file
  Index count = 0;         ///< of elements in the file
  std::string range_type = "I4";
  std::string number_type = "I4";
  std::string offset_type = {};  ///< of elements of several sizes: empty where the file has no offsets
  Index first_item = 0;          ///< of polygons, polyhedra: place of its first one in `Polyhedra`
};

/// The polygons and polyhedra of all zones, section after section. Does not change with the order.
struct Polyhedra {
  std::vector<Offset> corner_starts{0};  ///< polygons + 1
  std::vector<Index> corners;            ///< of polygons: vertices by their places in the file
  std::vector<Offset> face_starts{0};    ///< polyhedra + 1
  /// Of polyhedra: 1 + the place of a polygon, negative where its normal points into the polyhedron.
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

/// Vertices or cells that a node lists by their numbers in a zone.
struct PointList {
  int zone = 0;
  Association association = Association::vertices;
  std::vector<Index> members = {};  ///< positions in the mesh
  std::string set = {};             ///< of the mesh, with the same members; empty if there is none
  bool is_range = false;            ///< the file gave the first and the last number
  std::string number_type = "I4";
  bool is_shortened = false;  ///< members were left out
  bool orders_data = false;   ///< something has values for the members in their order
};

/// Cells on both sides of the elements of a section.
struct Parents {
  int section = 0;
  std::size_t columns = 2;              ///< values of an element: 2, or 4 with the numbers of faces
  std::vector<Index> rows = {};         ///< the cell, of polygons the polygon, that each row belongs to
  std::vector<Index> cells = {};        ///< two for each row; −1 for none
  std::vector<std::int64_t> rest = {};  ///< the values of other columns, column by column
  bool of_polygons = false;
  bool from_one = false;  ///< cells have numbers from 1, whatever those of their section
  std::string number_type = "I4";
};

/// What the values of a node are.
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
  int place = 0;           ///< of the zone, the section, the list or the parents
  int axis = 0;            ///< of a coordinate
  std::string type = {};   ///< of values and coordinates
  std::string array = {};  ///< of the mesh
  Index component = 0;     ///< of the array
  Association association = Association::vertices;
  int section = -1;  ///< of the cells that have values, in their order; −1: see `list`
  int list = -1;     ///< of the vertices or cells that have values, in their order; −1: all
};

/// The nodes of a file without the values that are in the mesh, and where these go.
struct Metadata final : FormatMetadata {
  std::shared_ptr<const Tree> tree;
  int cell_dimension = 3;
  bool has_labels = false;  ///< sections hold the labels of their cells
  std::vector<Zone> zones;
  std::vector<Section> sections;
  std::vector<PointList> lists;
  std::vector<Parents> parents;
  std::vector<Field> fields;
  std::vector<Index> zone_of_vertex;  ///< empty for one zone
  std::vector<Index> section_of_cell;
  std::shared_ptr<const Polyhedra> polyhedra;  ///< null if there are none
  std::vector<Index> cell_of_polygon;          ///< −1: none
  std::vector<Index> cell_of_polyhedron;       ///< −1: left out
  std::vector<Index> vertex_places;            ///< of the vertices of the file; empty: where they were
  std::vector<std::string> lost;               ///< see `contents`

  /// Returns where the vertex of that place in the file is now.
  [[nodiscard]] Index vertex_at(Index place) const {
    return vertex_places.empty() ? place : vertex_places[static_cast<std::size_t>(place)];
  }

  [[nodiscard]] std::vector<std::string> contents() const override { return lost; }
  [[nodiscard]] std::shared_ptr<const FormatMetadata> moved(std::span<const Index> vertices,
                                                            std::span<const Index> cells) const override;
};

/// Name of the node that holds the label of the cells of a section, and of the array of a cell's zone.
inline constexpr std::string_view kSectionLabel = "label";
inline constexpr std::string_view kZone = "zone";
/// Name of the node of a section that holds values of its cells: solutions are on those of the base's
/// dimension only.
inline constexpr std::string_view kSectionValues = "CellValues";

/// Returns the metadata of a mesh that came from CGNS, null if it did not.
const Metadata* own_metadata(const Mesh& mesh);

/// Returns what a file of a mesh of another format has: one zone with a section for each type and label.
/// `add_missing` adds what belongs to sets and arrays.
std::shared_ptr<Metadata> layout_of(const Mesh& mesh);

/// Adds to a copy of the nodes of a file the arrays and sets that none of its fields has. Notes what has no
/// place.
void add_missing(const Mesh& mesh, Metadata& metadata, Notes& notes);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

}  // namespace meshorder::cgns
