// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of Exodus II.
//
// Format: Schoof, Yarberry, "EXODUS II: A Finite Element Data Model" (Sandia, SAND92-2137), and the names of
// dimensions and variables in exodusII_int.h of SEACAS, https://sandialabs.github.io/seacas-docs/.
//
// - Element blocks become blocks of cells; their ids become labels (`kLabel`), and their names become sets
//   of cells.
// - Node sets become sets of vertices, and element sets become sets of cells.
// - A side set NAME becomes the array "side set NAME" on its elements: bit s − 1 of a value is set if side s
//   belongs to the set.
// - Distribution factors become arrays "… factors".
// - Attributes become arrays "attribute NAME".
// - Named maps become arrays "map NAME".
// - A nodal or element variable becomes an array NAME, or arrays "NAME step K" if there are several steps. A
//   set variable becomes, for example, "NAME on node set SET".

#include "io/exodus/netcdf.hpp"
#include "io/format.hpp"
#include "io/mesh_part.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::exodus {

inline constexpr std::string_view kAttribute = "attribute ";
inline constexpr std::string_view kMap = "map ";
inline constexpr std::string_view kFactors = " factors";
/// Name of the block property that holds the cells' labels if the blocks' ids cannot equal them.
inline constexpr std::string_view kLabelProperty = kLabel;

// ---- elements

/// Returns the shape of elements of a type. The type may be in upper or lower case, with or without the
/// number of nodes. Returns nullopt for unknown types, for types without a fixed number of nodes, and for too
/// few nodes.
std::optional<Shape> shape_of(std::string_view type, int nodes, int dimension);

/// Returns the name of the element type for these cells; empty if other programs do not know such a type.
std::string_view type_of(Shape shape, int nodes);

/// Returns, for each vertex of a cell, its position in the file's element; empty if both orders agree.
std::span<const int> file_order(Shape shape, int nodes);

inline constexpr int kMostSides = 6;

/// Returns how many of a surface element's first sides are faces, not edges, as in the library of Exodus II:
/// 2 for triangles in three dimensions and for shells of four corners, else 0.
int faces_of(Shape shape, std::string_view type, int dimension);

/// Returns the number of nodes of side `side`, counted from 1; 0 if there is no such side.
///
/// @param faces  as returned by `faces_of`
int nodes_of_side(Shape shape, int nodes, int side, int faces);

// ---- contents of a file besides the mesh

/// A nodal, element or set variable over all steps.
struct Series {
  std::string name;
  NcType type = kDouble;
  std::vector<std::string> arrays = {};  ///< the mesh's array of each step; empty if there are no values
  // both lists have an entry for each block if this is an element variable, else one entry
  std::vector<bool> present = {};   ///< whether the file's truth table marks values
  std::vector<bool> declared = {};  ///< whether the file has the netCDF variable, even without steps
};

struct BlockRecord {
  std::int64_t id = 0;
  std::string name;     ///< name in the file
  std::string in_mesh;  ///< name of the mesh's set of the block's cells; empty if there is none
  std::string type;
  std::int64_t label = 0;  ///< label of the block's cells; label, shape and nodes identify the block
  Shape shape = Shape::vertex;
  int nodes = 0;  ///< 0 for a block without elements
  NcType connect_type = kInt;
  NcType attribute_type = kDouble;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< name in the file, name of the array
  bool names_attributes = false;
  std::vector<std::int64_t> properties;
};

struct SetRecord {
  std::int64_t id = 0;
  std::string name;
  std::string in_mesh;  ///< name of the mesh's set; for side sets, of its array (empty: no sides)
  NcType type = kInt;
  NcType factor_type = kDouble;
  int factor_width = 0;          ///< side sets: the largest number of factors of a side
  bool factors_by_nodes = true;  ///< side sets: a side has a factor for each node, not `factor_width` factors
  std::vector<Series> variables;  ///< one for each variable of the family, which has the names
  std::vector<std::int64_t> properties;
};

/// Sets of one kind.
struct SetFamily {
  std::vector<SetRecord> sets;
  std::vector<std::string> properties;  ///< names, except ID
  std::vector<std::string> variables;   ///< names
  bool has_names = false;
};

/// A netCDF variable that is copied without changes.
struct PlainVariable {
  std::string name;
  NcType type;
  std::vector<Dimension> dimensions;
  std::vector<Attribute> attributes;
  std::string bytes;
};

/// A named map: a number for each node or element.
struct MapRecord {
  std::int64_t id = 0;
  std::string name;
  std::string array;
  NcType type = kInt;
};

/// Names of dimensions, netCDF variables and arrays for a kind of sets.
struct SetKind {
  std::string_view word;         ///< used in names of arrays and in messages
  std::string_view count;        ///< name of the dimension that counts the sets
  std::string_view prefix;       ///< begins the names of the netCDF variables of ids, names and status
  std::string_view members;      ///< begins the name of a set's netCDF variable of members
  std::string_view size;         ///< begins the name of the dimension that counts a set's members
  std::string_view factor_size;  ///< begins the name of the dimension that counts a set's factors
  std::string_view variable;     ///< part of names, as "nset" in vals_nset_var, name_nset_var, nset_var_tab
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

/// Returns the name of a set as names of arrays contain it, for example "node set NAME".
std::string title(const SetKind& kind, std::string_view in_mesh);

/// Data of a file beyond the mesh.
struct ExodusMetadata final : FormatMetadata {
  Storage storage{0};
  std::vector<Attribute> attributes;  ///< attributes of the file
  std::vector<Dimension> dimensions;  ///< dimensions whose lengths do not depend on the mesh
  std::vector<PlainVariable> plain;
  std::map<std::string, std::vector<Attribute>>
      variable_attributes;  ///< by name of the netCDF variable; without attributes that the format defines
  int coordinates = 3;      ///< number of coordinates of a point
  NcType coordinate_type = kDouble;
  bool packs_coordinates = false;  ///< all coordinates are in one variable, "coord"
  bool packs_nodal = false;        ///< all nodal variables are in one variable, "vals_nod_var"
  bool has_node_numbers = false;   ///< the file has node_num_map, even if its numbers are 1, 2, …
  bool has_element_numbers = false;
  /// Name of the file if it is a piece of a decomposed mesh, read without its communication maps; else empty.
  std::string piece;
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
  std::vector<std::pair<std::string, std::string>> nodal_attributes;  ///< name in the file, name of the array
  std::size_t name_length = 33;  ///< bytes of a name, its zero byte included

  [[nodiscard]] std::vector<std::string> contents() const override;
};

/// Returns the metadata of a mesh that was read from an Exodus file, else null.
inline const ExodusMetadata* own_metadata(const Mesh& mesh) {
  return dynamic_cast<const ExodusMetadata*>(mesh.format_metadata.get());
}

/// Returns "NAME step K" if there are several steps, else the name. `step` counts from 0, K from 1.
std::string name_of_step(const std::string& name, std::size_t step, std::size_t steps);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const UnfinishedFile& to, Notes& notes);

/// The sizes of a mesh, its blocks and its element variables, known without reading values.
struct Header {
  Index vertices;
  Index cells;
  std::vector<BlockRecord> blocks;  ///< without attributes; labels are ids
  std::vector<Index> block_ends;    ///< block b has the cells block_ends[b] to block_ends[b + 1] − 1
  std::vector<std::string> element_variables;
  bool is_piece;  ///< piece of a decomposed mesh
};

/// Reads the header of a file. Throws InputError as `read`.
Header read_header(const FilePath& path);

enum class PartContent : std::uint8_t { points_and_cells, all };

/// Reads the points and cells in some ranges of a file, with the arrays, sets and numbers that `read`
/// returns. Lists of sets are read completely, in chunks, but only members in the ranges are kept. O(size of
/// the part + entries of sets).
///
/// @param notes  receives the notes of `read` about this part, except those on repeated members and repeated
///               numbers. The caller, which has all parts, makes these by `note_of_repeated` and
///               `note_of_number_twice`
/// @throws InputError as `read`, for faults of the part, and for coordinates that are not finite
MeshPart read_part(const FilePath& path, const MeshRanges& ranges, PartContent content, Notes& notes);

/// Returns the position of each cell in a file: block by block, blocks of the highest dimension first;
/// `blocks` receives the position of each block's first cell.
Permutation places(const Mesh& mesh, std::vector<Index>& blocks);

}  // namespace meshorder::exodus
