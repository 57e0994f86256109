// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of Exodus II.
//
// Format: Schoof, Yarberry, "EXODUS II: A Finite Element Data Model" (Sandia, SAND92-2137), and the names of
// dimensions and variables in exodusII_int.h of SEACAS, https://sandialabs.github.io/seacas-docs/.
//
// In a Mesh, element blocks are the blocks of cells; `kLabel` has the block's id and a set of cells its name.
// Node sets are sets of vertices, element sets sets of cells. A side set NAME is the array "side set NAME" on
// its elements, of which bit s − 1 says that side s belongs to it. Distribution factors are arrays "…
// factors" and attributes arrays "attribute NAME", named maps arrays "map NAME". A variable is an array of
// its name, "NAME step K" where there are several steps, and of "NAME on node set SET" for a set.

#include "io/cell_division.hpp"
#include "io/exodus/netcdf.hpp"
#include "io/format.hpp"
#include "io/mesh_part.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace meshorder::exodus {

inline constexpr std::string_view kAttribute = "attribute ";
inline constexpr std::string_view kMap = "map ";
inline constexpr std::string_view kFactors = " factors";
/// Name of the property of blocks that holds the labels of cells where these cannot be the blocks' ids.
inline constexpr std::string_view kLabelProperty = kLabel;

// ---- elements

/// Returns the shape of the elements of a block: its type's, in any case and with or without the number of
/// nodes. Null for unknown types, for those without a fixed number of nodes, and for too few nodes.
const Shape* shape_of(std::string_view type, int nodes, int dimension);

/// Returns the name of the type that a block of these cells gets; empty if other programs know none.
std::string_view type_of(Shape shape, int nodes);

/// Returns the place in the file of each node of a cell; empty if they are in the order of a Mesh.
std::span<const int> file_order(Shape shape, int nodes);

inline constexpr int kMostSides = 6;

/// Returns the number of faces that elements of surfaces have as sides before their edges, as the library of
/// Exodus II counts them: 2 for triangles in three dimensions and for shells of four corners, none for
/// quadrilaterals of another type. 0 for other shapes.
int faces_of(Shape shape, std::string_view type, int dimension);

/// Returns the number of nodes of a side, from 1, 0 if there is no such side.
///
/// @param faces  as of `faces_of`
int nodes_of_side(Shape shape, int nodes, int side, int faces);

// ---- what a file has besides the mesh

/// A variable over all steps.
struct Series {
  std::string name;
  NcType type = kDouble;
  std::vector<std::string> arrays = {};  ///< of the mesh, one for each step; none for a name without values
  // by block for elements, one entry for nodes or a set
  std::vector<bool> present = {};   ///< a table of the file says that there are values
  std::vector<bool> declared = {};  ///< there is a variable for values, though there may be no step
};

struct BlockRecord {
  std::int64_t id = 0;
  std::string name;     ///< in the file
  std::string in_mesh;  ///< name of the set of its cells, empty if there is none
  std::string type;
  std::int64_t label = 0;  ///< of its cells; with shape and nodes it identifies the block
  Shape shape = Shape::vertex;
  int nodes = 0;  ///< 0 for a block without elements
  NcType connect_type = kInt;
  NcType attribute_type = kDouble;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< names in the file and of arrays
  bool names_attributes = false;
  std::vector<std::int64_t> properties;
};

struct SetRecord {
  std::int64_t id = 0;
  std::string name;
  std::string in_mesh;  ///< of the set or, for a side set, of the array; empty for one without members
  NcType type = kInt;
  NcType factor_type = kDouble;
  int factor_width = 0;           ///< of sides: the most factors of one
  bool factors_by_nodes = true;   ///< of sides: a side has as many factors as nodes, not factor_width
  std::vector<Series> variables;  ///< as many as the family has, without their names
  std::vector<std::int64_t> properties;
};

/// Sets of one kind.
struct SetFamily {
  std::vector<SetRecord> sets;
  std::vector<std::string> properties;  ///< names of those besides ID
  std::vector<std::string> variables;   ///< names
  bool has_names = false;
};

/// A variable that is kept as it is.
struct PlainVariable {
  std::string name;
  NcType type;
  std::vector<Dimension> dimensions;
  std::vector<Attribute> attributes;
  std::string bytes;
};

/// A numbering of all nodes or elements with a name.
struct MapRecord {
  std::int64_t id = 0;
  std::string name;
  std::string array;
  NcType type = kInt;
};

/// How the names of a kind of sets are built.
struct SetKind {
  std::string_view word;         ///< in names of arrays and in messages
  std::string_view count;        ///< dimension
  std::string_view prefix;       ///< of ids, names and status
  std::string_view members;      ///< variable
  std::string_view size;         ///< dimension
  std::string_view factor_size;  ///< dimension
  std::string_view variable;     ///< "nset" in vals_nset_var, name_nset_var, nset_var_tab
  Association association;
};

inline constexpr std::array kSetKinds{
    SetKind{"node set ", "num_node_sets", "ns", "node_ns", "num_nod_ns", "num_df_ns", "nset",
            Association::vertices},
    SetKind{"side set ", "num_side_sets", "ss", "elem_ss", "num_side_ss", "num_df_ss", "sset",
            Association::cells},
    SetKind{"element set ", "num_elem_sets", "els", "elem_els", "num_ele_els", "num_df_els", "elset",
            Association::cells},
};
inline constexpr std::size_t kNodeSets = 0;
inline constexpr std::size_t kSideSets = 1;
inline constexpr std::size_t kElementSets = 2;

/// Returns what arrays call a set: "node set NAME".
std::string title(const SetKind& kind, std::string_view in_mesh);

/// Data of a file beyond the mesh.
struct Metadata final : FormatMetadata {
  Storage storage{0};
  std::vector<Attribute> attributes;  ///< of the file
  std::vector<Dimension> dimensions;  ///< those that no part of the mesh decides
  std::vector<PlainVariable> plain;
  std::map<std::string, std::vector<Attribute>>
      variable_attributes;  ///< others than the format's, by variable
  int coordinates = 3;      ///< of a point
  NcType coordinate_type = kDouble;
  bool packs_coordinates = false;  ///< in one variable "coord"
  bool packs_nodal = false;        ///< all nodal variables in one variable
  bool has_node_numbers = false;   ///< node_num_map is there, though it may be 1, 2, …
  bool has_element_numbers = false;
  bool is_piece = false;  ///< of a decomposed mesh, whose communication maps have been left out
  bool steps_unlimited = true;
  std::size_t steps = 0;
  std::vector<BlockRecord> blocks;
  std::vector<std::string> block_properties;
  bool names_blocks = false;
  std::array<SetFamily, kSetKinds.size()> sets;
  std::vector<Series> nodal;
  std::vector<Series> elements;
  std::vector<MapRecord> node_maps;
  std::vector<MapRecord> element_maps;
  std::vector<std::pair<std::string, std::string>> nodal_attributes;  ///< names in the file and of arrays
  std::size_t name_length = 33;  ///< bytes of a name, its zero byte included

  [[nodiscard]] std::vector<std::string> contents() const override;
};

/// Returns "NAME step K" where there are several steps, else the name.
std::string name_of_step(const std::string& name, std::size_t step, std::size_t steps);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const UnfinishedFile& to, Notes& notes);

/// What a file says of its mesh before any of its values.
struct Header {
  Index vertices;
  Index cells;
  std::vector<BlockRecord> blocks;  ///< without names and properties
  std::vector<Index> block_ends;    ///< blocks + 1: block b has the cells from entry b to entry b + 1
  std::vector<std::string> element_variables;
  bool is_piece;  ///< of a decomposed mesh
};

/// Reads the header of a file. Throws InputError as `read`.
Header read_header(const FilePath& path);

enum class PartContent : std::uint8_t { points_and_cells, all };

/// Reads ranges of the points and cells of a file, and what they have of all that `read` makes of it. Lists
/// of sets are read as a whole, piece by piece, and only members that are in the ranges kept. O(size of the
/// part + entries of sets).
///
/// @param notes  receives what `read` notes of the part; repeated members and numbers of vertices and cells
///               are for those to judge who know all parts, see `note_of_repeated`, `note_of_number_twice`
/// @throws InputError as `read`, for faults of the part, and for coordinates that are not finite
MeshPart read_part(const FilePath& path, const MeshRanges& ranges, PartContent content, Notes& notes);

// ---- blocks of a mesh

using Block = CellPart;

/// Returns the division of a mesh, by sets for one of another format only.
CellDivision divide(const Mesh& mesh);

/// Counts the nodes of sides of cells, which depend on the type of the block that a cell is in.
class SideNodes {
 public:
  /// Takes the blocks of a file that the mesh came from. O(cells). The mesh has to outlive this object.
  SideNodes(const Mesh& mesh, const Metadata& metadata);

  /// Returns the number of nodes of a side, from 1, 0 if there is no such side. O(log blocks).
  [[nodiscard]] int count(Index cell, int side) const;

 private:
  const Mesh& mesh_;
  std::vector<std::int64_t> labels_;                                   ///< of the cells; empty if all are 0
  std::map<std::tuple<std::int64_t, Shape, int>, std::string> types_;  ///< by label, shape and nodes
};

/// Returns the places of cells block by block, cells of the highest dimension first; `blocks` receives the
/// first cell of each.
Permutation places(const Mesh& mesh, std::vector<Index>& blocks);

}  // namespace meshorder::exodus
