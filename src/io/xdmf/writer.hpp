// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Writes .xdmf files and the files of values that they name. Mesh data for which the layout has a field are
// written to this field; other data are added.

#include "io/hdf5/hdf5_file.hpp"
#include "io/named_parts.hpp"
#include "io/names.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/output_file.hpp"
#include "io/xdmf/data_item.hpp"
#include "io/xdmf/document.hpp"
#include "io/xdmf/xdmf.hpp"
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::xdmf {

/// An HDF5 file that is being written.
struct Hdf5Output {
  std::string name;  ///< name in the new XML
  std::unique_ptr<hdf5::NewFile> out;
  hdf5::File* file = nullptr;
  std::set<std::string> datasets;
  std::set<std::string> written;  ///< datasets to which values of the mesh have been written
  int next_array = 0;             ///< lowest number that may be free for a dataset /Attributes/NUMBER
};

/// Writes the files of a layout: see `write` and `SplitFile`.
class Writer {
 public:
  /// `rows`: the cells of each part.
  Writer(const Mesh& mesh, const XdmfLayout& layout, std::vector<std::vector<Index>> rows,
         const FilePath& path, Notes& notes);
  /// Writes the file and the files of values that it names.
  void write();
  /// See `SplitFile`; `mark` is `mark_of(checksum)`.
  std::string write_without_values(const std::filesystem::path& data, const std::string& mark);
  /// Returns the new name of an HDF5 file that the old XML names; it follows the name of the new .xdmf file.
  [[nodiscard]] std::string new_name(const std::string& old_name) const;

 private:
  // files
  void open_files();
  void rename_files();
  [[nodiscard]] std::string mark_of_mesh() const;
  /// Marks the files as belonging to one mesh.
  void mark_files(const std::string& mark);
  void put_xml(const TakeText& take) const;

  // values of one DataItem: value_writer.cpp
  static void set_shape(pugi::xml_node item, const std::vector<std::uint64_t>& shape);
  /// Returns the shape of `count` values at a place: the old shape if it fits, else rows of `components`.
  std::vector<std::uint64_t> shape_at(const DataPlace& place, std::size_t count, std::size_t components);
  /// Returns whether another field has written other values to the dataset of a place: an array on cells and
  /// one on vertices may share a dataset. From the first call on, the dataset counts as written.
  bool is_taken(const DataPlace& place, const Values& values);
  /// Sets the shape and the number type of a DataItem for values in rows of `components`; returns the
  /// shape.
  static std::vector<std::uint64_t> describe(pugi::xml_node item, const Values& values,
                                             std::size_t components);
  /// Writes values to a dataset that no other field has, and names the dataset in the DataItem. `file`: name
  /// of the HDF5 file in the old XML.
  void put_apart(pugi::xml_node item, const std::string& file, const std::string& dataset,
                 const Values& values, const std::vector<std::uint64_t>& shape);
  /// Returns the DataItems that have the values of a place.
  [[nodiscard]] std::vector<pugi::xml_node> items_at(const DataPlace& place) const;
  /// Writes values to a place in their own number type, in rows of `components` values.
  void put(const DataPlace& place, const Values& values, std::size_t components);
  /// Writes indices to a place in the place's number type, or as 32-bit integers if that type is narrower.
  void put_indices(const DataPlace& place, std::span<const Index> indices, std::size_t components);
  /// Records a dataset; in a made layout, names it in the XML. `rename_files` then replaces the file's name.
  void name_dataset(const DataPlace& place);
  void put_binary(pugi::xml_node item, const DataPlace& place, const Values& values);
  static std::string text_of_values(const Values& values, std::size_t components);

  // fields of the layout: field_writer.cpp
  /// Gives each field its own DataItems if references make several fields share one.
  void part_references();
  /// Returns the Topology, Geometry, Attribute or Set that has the values of a field.
  [[nodiscard]] pugi::xml_node element_of(const Field& field) const;
  void write_field(const Field& field);
  void write_points(const Field& field);
  void write_topology(const Field& field);
  /// Writes the number of cells, which follows from a field's shape, to the field's Topology.
  void announce_cells_of(const Field& field) const;
  /// Updates a Topology's number of cells, if it gives one.
  void announce_cells(pugi::xml_node topology, std::uint64_t cells) const;
  /// Returns whether the cell is a linear wedge whose first triangle faces outward in the file.
  [[nodiscard]] bool is_turned(Index c) const;
  /// Returns the type of these cells, null if they have several types or a type that XDMF lacks, or if `rows`
  /// is empty.
  [[nodiscard]] const TopologyType* common_type(const std::vector<Index>& rows) const;
  /// Returns the values of a Topology of these cells; if `mixed`, each cell's type precedes its points.
  [[nodiscard]] std::vector<Index> numbers_of(const std::vector<Index>& rows, bool mixed, int base) const;
  void write_array(const Field& field);
  void write_set(const Field& field);
  /// Removes the Attributes and Sets of `gone_`, and their datasets unless other elements name them.
  void remove_gone();
  /// Returns the row of each cell in the part with the cells `rows`; −1 for other cells.
  [[nodiscard]] std::vector<Index> places_in(const std::vector<Index>& rows) const;
  /// Returns the values of an array for all vertices or for the cells of a part; nullopt if the array already
  /// has exactly these values. Notes rows that the array lacks.
  std::optional<Values> values_of(const DataArray& array, Association association, int part);

  // data that the layout has no field for: attribute_writer.cpp
  /// Returns the array of marks of the set that "set:NAME" names; nullopt if there is no such set.
  [[nodiscard]] std::optional<DataArray> marks_named(const std::string& name, Association association) const;
  void add_others();
  /// Returns the sets for which the layout has a part or a field; none for a made layout.
  [[nodiscard]] std::set<std::pair<Association, std::string>> placed_sets() const;
  void add_ids(const std::vector<std::int64_t>& ids, const char* name, Association association);
  void add_array(const DataArray& array);
  [[nodiscard]] bool has_rows(const DataArray& array, const std::vector<Index>& cells) const;
  void add_attribute(int part, const DataArray& array, const std::string& name, const Values& values);
  static std::string unused_dataset(Hdf5Output& output, int part, const std::string& name);

  const Mesh& mesh_;
  const NamedParts parts_{mesh_};
  const XdmfLayout& layout_;
  std::vector<Field> fields_;
  FilePath path_;
  std::string stem_;
  Notes& notes_;
  std::vector<std::vector<Index>> rows_;  // cells of each part
  pugi::xml_document xml_;
  std::vector<pugi::xml_node> items_;
  std::vector<pugi::xml_node> grids_;
  std::map<std::string, Hdf5Output> files_;  // by names in the old XML
  std::map<std::string, std::vector<std::uint64_t>>
      shapes_;  // shapes that have changed, by the new name of a dataset
  std::vector<OutputFile> binaries_;
  std::set<const Field*> gone_;                 // fields that the mesh no longer has
  std::map<Association, DistinctNames> names_;  // names of arrays
};

/// Sets the attribute `other` if the element has `other` but not `name`; otherwise sets or adds `name`.
void set_either(pugi::xml_node element, const char* name, const char* other, const std::string& value);

/// Returns the AttributeType of values with that many components.
std::string attribute_type(Index components);

}  // namespace meshorder::xdmf
