// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Declarations shared by the reader and the writer of MED 3 and 4.
//
// Format: "Modèle de données et format de fichiers MED 4" (EDF R&D, CEA), and the groups, datasets and
// attributes that its library writes. The node orders of cells are those of Gmsh's writer of MED.
//
// In a Mesh, the cells of a type are a block of cells. Groups are sets of vertices and of cells, and the
// family numbers are an array `kLabel`. A field becomes an array of the same name, or arrays "NAME step K" if
// it has several steps. The values at the nodes of cells and at Gauss points are arrays "NAME at nodes of
// TE4" and "NAME at Gauss points of TE4"; a row has the components of all points, one point after another.

#include "io/format.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include "io/names.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::med {

inline constexpr std::string_view kNoProfile = "MED_NO_PROFILE_INTERNAL";
inline constexpr std::string_view kNames = "name";                   ///< name of the array with item names
inline constexpr std::string_view kGlobalNumbers = "global number";  ///< name of the array with GLB numbers
/// Name of the array of family numbers if the file has a field named `kLabel`.
inline constexpr std::string_view kFamilies = "family";
inline constexpr std::size_t kLongestName = 64;   ///< characters in the name of a field, profile or family
inline constexpr std::size_t kLongestGroup = 80;  ///< characters in the name of a group
inline constexpr std::size_t kShortName = 16;     ///< characters in the name of a component, node or cell

// ---- types of cells

struct GeometryType {
  std::string_view name;  ///< name of its group in the file
  int number;             ///< attribute GEO
  Shape shape;
  int nodes;
};

/// Returns all types, in the sequence in which `group_cells_by_type` arranges cells.
std::span<const GeometryType> geometry_types();
/// Returns the type of that name, null if there is none.
const GeometryType* geometry_type(std::string_view name);
/// Returns the type of these cells, null if there is none.
const GeometryType* geometry_type(Shape shape, int nodes);
/// Returns, for each node of the file's cell, the position in a Mesh's cell; empty if both orders agree.
std::span<const int> mesh_order(const GeometryType& type);

// ---- contents of a file besides the mesh

/// A family: cells or vertices that belong to the same groups.
struct Family {
  std::int64_t number = 0;
  std::vector<std::string> groups = {};  ///< names of sets of the mesh, ascending
};

/// Values of a field for vertices or for the cells of one type, at one step.
struct Piece {
  std::string field = {};
  std::string support = {};            ///< path of the group "/CHA/field/step/MAI.TE4"
  std::string profile = {};            ///< name of the profile; kNoProfile if there is none
  std::string array = {};              ///< name of the array in the mesh
  const GeometryType* type = nullptr;  ///< null: vertices
  bool at_nodes = false;               ///< the values are at the nodes of cells
  std::size_t components = 1;
  std::size_t points = 1;       ///< nodes or Gauss points of a cell
  bool counts_profile = false;  ///< attribute NBR is the size of the profile, not of the mesh
};

/// Pairs of vertices, or of cells of one type, that the file declares equivalent.
struct Equivalence {
  std::string dataset;
  const GeometryType* type = nullptr;  ///< null: vertices
  std::vector<Index> members = {};     ///< vertices or cells of the mesh, two for each pair
};

/// What the file has for the vertices or for the cells of a type.
struct Items {
  bool has_numbers = false;
  bool has_families = false;
};

/// Consecutive vertices, or consecutive cells of one type.
struct Range {
  Index first = 0;
  Index count = 0;
};
/// The vertices (type null) and the cells of each type of a mesh.
using Ranges = std::map<const GeometryType*, Range>;
/// Returns the range of a type; an empty range if the mesh has no such cells.
Range range_in(const Ranges& ranges, const GeometryType* type);

/// Data of a file beyond the mesh.
struct MedLayout final : FormatMetadata {
  std::shared_ptr<const std::string> file;           ///< bytes of the file without the mesh's values
  std::string mesh;                                  ///< name of the mesh
  std::string step;                                  ///< name of the group of the only step
  bool is_made = false;                              ///< whether `new_layout` made the layout
  bool in_mesh_order = false;                        ///< whether the file has cells' nodes in Mesh's order
  int axes = 3;                                      ///< coordinates of a point
  std::map<const GeometryType*, Items> items;        ///< by type; null: vertices
  std::string families_array = std::string(kLabel);  ///< mesh's array with the family numbers
  std::array<std::vector<Family>, 2> families;       ///< by association
  std::vector<Piece> pieces;
  std::vector<Equivalence> equivalences;
  std::vector<std::string> words;  ///< what `contents` returns

  [[nodiscard]] std::string mesh_path() const { return "/ENS_MAA/" + mesh; }
  [[nodiscard]] std::string step_path() const { return mesh_path() + "/" + step; }
  [[nodiscard]] std::string cells_path() const { return step_path() + "/MAI"; }
  /// Returns the path of the group of the vertices (null) or of the cells of a type.
  [[nodiscard]] std::string path_of(const GeometryType* type) const;
  [[nodiscard]] std::string families_path(Association association) const;
  /// Returns, for each point of a cell in the file, the position in an array's row; empty if both orders
  /// agree.
  [[nodiscard]] std::span<const int> order_of_points(const Piece& piece) const;

  [[nodiscard]] std::vector<std::string> contents() const override { return words; }
  [[nodiscard]] std::shared_ptr<const FormatMetadata> moved(std::span<const Index> new_vertices,
                                                            std::span<const Index> new_cells) const override;
};

/// Returns a text in UTF-8; a text that is not valid UTF-8 is taken to be Latin-1.
std::string utf8(std::string text);

/// Returns the path of the dataset of a profile.
std::string profile_path(const std::string& profile);

/// Returns the layout of a file for a mesh of another format.
MedLayout new_layout(const Mesh& mesh);

Mesh read(const FilePath& path, Notes& notes);
void write(const Mesh& mesh, const FilePath& path, Notes& notes);

// ---- parts of the reader

/// A file that is being read, and the results so far.
struct Reading {
  Reading(const FilePath& path, Notes& warnings);

  /// Throws InputError for a fault at a group or a dataset.
  [[noreturn]] void fail(const std::string& path, const std::string& what,
                         const std::string& remedy = "the file may be damaged") const;
  /// Sorts an array's rows by vertex or cell, adds the array under an unused name and returns this name.
  std::string add_array(DataArray array);
  /// Marks a dataset not to keep verbatim.
  void take(const std::string& path) { taken.insert(hdf5::normal_path(path)); }

  hdf5::File file;
  std::shared_ptr<MedLayout> layout = std::make_shared<MedLayout>();
  Mesh mesh;
  Ranges ranges;
  std::set<std::string> taken;
  Notes& notes;

 private:
  UniqueNames arrays_;
};

void read_families(Reading& reading);
void read_fields(Reading& reading);

// ---- parts of the writer

/// A file that is being written.
struct Writing {
  const Mesh& mesh;
  const MedLayout& layout;
  hdf5::File& file;
  Notes& notes;
  Ranges ranges;
  std::set<const DataArray*> placed;  ///< arrays written already, which need no field

  /// Writes numbers of `rows` items to a dataset and sets its attributes.
  void put(const std::string& path, const Values& values, Index rows);
  /// Writes whole numbers with 32 bits, or with 64 bits if the dataset already has 64 bits or a number needs
  /// them.
  void put_integers(const std::string& path, std::vector<std::int64_t> values);
};

/// Attributes that are whole numbers.
using Numbers = std::initializer_list<std::pair<const char*, std::int64_t>>;
void set_attributes(hdf5::File& file, const std::string& path, Numbers numbers);

/// Writes new families; returns the family number of each vertex or cell, empty if all are 0.
std::vector<std::int64_t> write_families(Writing& writing, Association association);
void write_fields(Writing& writing);

}  // namespace meshorder::med
