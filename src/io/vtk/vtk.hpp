// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "io/vtk/polyhedra.hpp"
#include "io/vtu.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// Declarations shared by the readers and writers of VTK's formats, .vtu, .vtkhdf and legacy .vtk.
namespace meshorder::vtk {

// ---- number types

/// Names of number types in .vtu files and in legacy files, in the order of the alternatives of Values.
inline constexpr std::array<std::string_view, std::variant_size_v<Values>> kXmlTypeNames{
    "Float64", "Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "String"};
inline constexpr std::array<std::string_view, std::variant_size_v<Values>> kLegacyTypeNames{
    "double", "float",        "char",         "unsigned_char", "short", "unsigned_short",
    "int",    "unsigned_int", "vtktypeint64", "vtktypeuint64", "string"};

/// Converts integers to the type Target; returns an empty vector if the values are not integers.
template <class Target>
std::vector<Target> integers_of(const Values& values) {
  return with_integers(
      values, [](const auto& numbers) { return std::vector<Target>(numbers.begin(), numbers.end()); });
}

// ---- metadata

/// The uses of arrays that VTK distinguishes: the scalars that a viewer colours by, and so on.
enum class Role : std::uint8_t {
  scalars,
  vectors,
  normals,
  texture_coordinates,
  tensors,
  global_ids,
  pedigree_ids,
  edge_flag,
  tangents,
  rational_weights,
  higher_order_degrees,
  color_scalars,  ///< in legacy files only
};

/// XML attributes that name the array of a role, in the order of Role.
inline constexpr std::array<std::string_view, 11> kXmlRoles{
    "Scalars",     "Vectors",  "Normals",  "TCoords",         "Tensors",           "GlobalIds",
    "PedigreeIds", "EdgeFlag", "Tangents", "RationalWeights", "HigherOrderDegrees"};

/// A keyword of legacy files that gives an array a role.
struct LegacyAttribute {
  std::string_view keyword;
  Role role;
  int components;  ///< required number of components; 0: any
};

inline constexpr std::array kLegacyAttributes{
    LegacyAttribute{"SCALARS", Role::scalars, 0},
    LegacyAttribute{"COLOR_SCALARS", Role::color_scalars, 0},
    LegacyAttribute{"VECTORS", Role::vectors, 3},
    LegacyAttribute{"NORMALS", Role::normals, 3},
    LegacyAttribute{"TEXTURE_COORDINATES", Role::texture_coordinates, 0},
    LegacyAttribute{"TENSORS", Role::tensors, 9},
    LegacyAttribute{"TENSORS6", Role::tensors, 6},
    LegacyAttribute{"GLOBAL_IDS", Role::global_ids, 1},
    LegacyAttribute{"PEDIGREE_IDS", Role::pedigree_ids, 1},
    LegacyAttribute{"EDGE_FLAGS", Role::edge_flag, 1},
};

/// Sections of cells in legacy POLYDATA files. Cell data list the cells in this order of sections.
inline constexpr std::array<std::string_view, 4> kPolydataSections{"VERTICES", "LINES", "POLYGONS",
                                                                   "TRIANGLE_STRIPS"};

/// The array name under which facts about the coordinates are kept.
inline constexpr std::string_view kPoints = "POINTS";

/// XML names of compressors, in the order of VtuEncoding::Compressor.
inline constexpr std::array<std::string_view, 4> kCompressors{
    "", "vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"};

/// An array and its role. If a legacy file has several arrays of one role, the first array has the role.
struct ArrayRole {
  Role role;
  Association association;
  std::string array;
  std::string lookup_table;  ///< name of the lookup table of legacy scalars
};

/// Properties of an array that DataArray does not hold.
struct ArrayFacts {
  std::optional<Association> association;  ///< nullopt: an array of the whole mesh
  std::string array;
  std::string type;             ///< a number type that Values cannot express: "vtkIdType", "long"
  std::string information;      ///< legacy: the lines of its INFORMATION
  std::string xml_information;  ///< .vtu: its InformationKey elements
};

/// Layout of a legacy file.
struct LegacyLayout {
  std::string version = "4.2";
  std::string title = "written by meshorder";
  bool binary = true;
  bool polydata = false;
  struct LookupTable {
    Association association;
    std::string name;
    Index size;
    std::string content;  ///< verbatim, text or bytes
  };
  std::vector<LookupTable> lookup_tables;
};

/// Facts of arrays by their association and name.
using FactsOfArrays = std::map<std::pair<std::optional<Association>, std::string>, ArrayFacts>;

/// Data of VTK's files beyond the mesh, kept by the readers for the writers.
struct VtkMetadata : FormatMetadata {
  std::vector<DataArray> fields;  ///< arrays of the whole mesh; their association and indices are unused
  std::vector<ArrayRole> roles;
  FactsOfArrays facts;
  bool float_points = false;
  bool inward_wedges = false;  ///< linear wedges in the order of VTK 9.7, see take_cells
  std::optional<VtuEncoding> vtu;
  std::optional<LegacyLayout> legacy;
  Polyhedra polyhedra;

  [[nodiscard]] std::vector<std::string> contents() const override;
  [[nodiscard]] std::shared_ptr<const FormatMetadata> moved(std::span<const Index> new_vertices,
                                                            std::span<const Index> new_cells) const override;
};

/// Returns the facts of an array, or nullptr. O(log facts).
const ArrayFacts* find_facts(const VtkMetadata& metadata, std::optional<Association> association,
                             std::string_view array);

// ---- cells

/// Name of the array of VTK's cell types. The array is kept if shapes and numbers of vertices do not
/// determine the types: a tetrahedron of 10 nodes may be a quadratic or a Lagrange one.
inline constexpr std::string_view kCellTypes = "vtk:type";

/// Cells as in VTK's files: types of vtkCellType.h; cell c has vertices `offsets[c]` … `offsets[c + 1] − 1`.
struct FileCells {
  std::vector<std::uint8_t> types;
  std::vector<Offset> offsets{0};
  std::vector<Index> vertices;
  Polyhedra polyhedra;
};

/// Makes the error for a fault of cells or pieces: (what, remedy).
using ErrorAt = std::function<InputError(const std::string&, const std::string&)>;

/// Gives `mesh` these cells, with their vertices in the order of a Mesh. Pixels and voxels become quads and
/// hexahedra, which is noted. Type numbers that shapes and numbers of vertices do not determine are kept as
/// the array kCellTypes. Moves the contents of `cells` out, except the polyhedra; the types move to the array
/// kCellTypes or stay. O(vertex entries).
///
/// The first triangle of a linear wedge faces outward up to VTK 9.6 and inward since then. Files do not say
/// which; the volumes of their cells decide.
///
/// @return whether the first triangles of the file's wedges face inward, as in a Mesh
/// @throws `error` for types without a Shape, for cells with a wrong number of vertices, and for polyhedra
///         without faces on their vertices
bool take_cells(Mesh& mesh, FileCells& cells, const ErrorAt& error, Notes& notes);

/// Returns whether the mesh was read from one of VTK's formats.
bool is_from_vtk(const Mesh& mesh);

/// Returns whether VTK has a type for these cells. The node numbering above second order, and the faces of
/// polyhedra, are known only for meshes from VTK. Prisms of five and six sides, which have types of their
/// own, are polyhedra here.
bool holds(const Mesh& mesh, Shape shape, int vertices);

/// Returns whether the mesh has polyhedra whose faces were read from a file of VTK.
bool has_polyhedra(const Mesh& mesh);

/// Returns VTK's type number of every cell. `holds` must be true for all cells.
std::vector<std::uint8_t> cell_types(const Mesh& mesh);

/// Returns the first polyhedron that has no faces, or that has a face with a corner that is not a vertex of
/// the polyhedron; −1 if there is none. O(vertex entries + numbers of the faces).
Index first_unfit_polyhedron(const Cells& cells, const std::vector<std::uint8_t>& types,
                             const Polyhedra& polyhedra, Index vertex_count);

/// Returns true for higher-order hexahedra, whose nodes VTK numbered differently before VTK 9 (files before
/// XML version 2.1 and legacy version 5.1).
bool is_higher_order_hexahedron(std::uint8_t type);

/// Returns whether a file may list the nodes of a cell of that type in another order than a Mesh.
bool may_be_reordered(std::uint8_t type);

/// Swaps, in all higher-order hexahedra of `cells`, the two edges that VTK 9 numbers differently; a second
/// call swaps them back. Degrees come from the array HigherOrderDegrees of the mesh, if any.
void swap_hexahedron_edges(const Mesh& mesh, const std::vector<std::uint8_t>& types, Cells& cells);

// ---- reading

/// Appends points from their coordinates, three for each. Throws `not_finite(k)` if new point k, counted from
/// 0, has a coordinate that is not finite. Integers are converted; texts make no points. O(points).
void add_points(std::vector<Point>& points, const Values& coordinates,
                const std::function<InputError(std::size_t k)>& not_finite);

/// Adds an array of a file to the mesh. An array of integers named "set:NAME" that marks members by 1, or by
/// their rank from 1, becomes the set NAME.
void add_array(Mesh& mesh, DataArray array);

Mesh read_legacy(const FilePath& path, Notes& notes);
Mesh read_vtu(const FilePath& path, Notes& notes);

// ---- writing

/// Prefix of names of arrays that hold sets. "set:NAME" marks the members of the set NAME: by 1 if the
/// members ascend, else by their ranks from 1, to keep their order.
inline constexpr std::string_view kSetPrefix = "set:";

/// Returns the array "set:NAME" of a set. `count` is the number of all vertices or cells.
DataArray marks_of(const EntitySet& set, Index count);

/// Returns an array with a row for each of `count` vertices or cells; rows that `array` lacks are NaN or 0.
DataArray full_array(const DataArray& array, Index count);

/// Where a file stores the names of its arrays; this decides which characters they may have.
enum class NamePlace : std::uint8_t { legacy, xml, hdf5 };

/// Returns a name made valid as the name of an HDF5 dataset, where a slash separates groups, a dot is the
/// group itself, and a zero byte ends a name.
std::string name_in_hdf5(std::string name);

/// The input of the writers, made from a mesh. Borrows the mesh and the notes.
///
/// VTK's formats hold full arrays only: partial arrays are filled up, sets become arrays "set:NAME" and ids
/// become arrays "vertex_id" and "cell_id". The notes report all of this. O(size of the arrays that are
/// made).
struct WriteContext {
  /// `written`: a mesh whose cells VTK's formats hold. Throws InvalidArgument if the faces of polyhedra in
  /// the metadata are not on their vertices, as after a change of the mesh.
  WriteContext(const Mesh& written, Notes& warnings, NamePlace names);

  /// Returns the cells in VTK's order of vertices; hexahedra in the order before VTK 9 if `old_hexahedra`.
  /// The result belongs to the mesh or to this object.
  const Cells& cells(bool old_hexahedra = false);
  /// Returns the cells as `cells` does, but with the faces of polyhedra instead of their vertices, as legacy
  /// files have them. The result belongs to the mesh or to this object.
  const Cells& cells_with_faces(bool old_hexahedra);

  /// Returns the array that is written with that role, null if there is none.
  [[nodiscard]] const ArrayRole* role(Association association, Role role) const;

  /// Returns the coordinates of the points, three for each.
  [[nodiscard]] std::span<const double> coordinates() const {
    return {mesh.points.empty() ? nullptr : mesh.points.front().data(), 3 * mesh.points.size()};
  }

  /// Returns whether the points were floats in their file and can still be written so without loss.
  [[nodiscard]] bool points_are_floats() const;

  const Mesh& mesh;
  Notes& notes;
  const VtkMetadata& metadata;           ///< metadata of a mesh that came from VTK; else empty
  std::vector<std::uint8_t> types;       ///< VTK types of the cells
  std::vector<const DataArray*> arrays;  ///< full arrays with distinct names, in order

 private:
  void collect_arrays(NamePlace place);
  void add_made(DataArray array);

  std::vector<std::unique_ptr<DataArray>> made_;  // arrays that are not the mesh's
  Cells changed_;
};

// ---- meshes in pieces

/// The contents of the pieces of a mesh, one piece after another. Refers to members of a reader.
struct Pieces {
  std::vector<Point>& points;
  FileCells& cells;
  std::vector<DataArray>& arrays;  ///< arrays of all points or cells
  std::vector<ArrayRole>& roles;
};

/// Makes one mesh of its pieces, in place:
/// - Leaves out the cells that `vtkGhostType` marks as cells of another piece, and the points that it marks
///   and that no remaining cell uses. Leaves out `vtkGhostType` itself if it marks nothing else.
/// - Sorts points and cells by their global ids, which are in the array with the role `global_ids`, else in
///   that with VTK's usual name. Leaves out ids that are 0, 1, 2 …
/// - Merges the copies of a point in several pieces, with the values of the piece that owns the point. If
///   points have no ids, each piece keeps its copy; a note says so.
///
/// Throws `error` for ids below 0, for points with one id but different coordinates, and for two cells with
/// one id. O(n log n) for n points and cells.
void join_pieces(const Pieces& pieces, const ErrorAt& error, Notes& notes);

void write_vtu(const Mesh& mesh, const FilePath& path, Notes& notes);

}  // namespace meshorder::vtk
