// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Arrays of XDMF files: DataItem elements and the values that they name.

#include "io/hdf5/hdf5_file.hpp"
#include "io/stream/file_path.hpp"
#include "io/xdmf/document.hpp"
#include <meshorder/mesh.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::xdmf {

/// Where the values of a DataItem are.
struct DataPlace {
  enum class Format : std::uint8_t { xml, hdf, binary };
  Format format = Format::xml;
  std::size_t item = 0;                     ///< number of the DataItem element; see `Document::number`
  std::string file = {};                    ///< name of the file in the XML
  std::string dataset = {};                 ///< path in an HDF5 file
  std::size_t alternative = 0;              ///< number type of the values: index of an alternative of Values
  std::endian order = std::endian::native;  ///< byte order in a binary file
  std::uint64_t seek = 0;                   ///< first byte in a binary file
  std::vector<std::uint64_t> shape = {};
  /// Number of the DataItem in the Topology, Geometry, Attribute or Set: `item`, or one that refers to
  /// `item`.
  std::size_t named_by = 0;

  /// Another DataItem that names the same values, for example in another time step.
  struct Repeat {
    std::size_t item;
    std::size_t named_by;
  };
  std::vector<Repeat> repeats = {};

  /// Returns the number of values.
  [[nodiscard]] std::uint64_t count() const;
  /// Adds another DataItem that names the same values.
  void repeat(const DataPlace& other);
};

/// Returns a key of an array: DataItems with the same key have the same values.
std::string key_of(const DataPlace& place);

/// Returns the XML attributes NumberType and Precision for an alternative of Values.
std::pair<std::string, int> number_type_of(std::size_t alternative);

/// Splits "mesh.h5:/Mesh/topology" into the file and the path in it.
std::pair<std::string, std::string> split_hdf5_name(std::string_view text);

/// Reads the arrays that a document names; each HDF5 file is opened once.
class DataReader {
 public:
  DataReader(const Document& document, FilePath path) : document_(document), path_(std::move(path)) {}

  /// Returns where the values of a DataItem are; follows references. Throws InputError if the DataItem is not
  /// supported.
  [[nodiscard]] DataPlace place_of(pugi::xml_node item);
  /// Returns the values of a place, as many as its shape says.
  [[nodiscard]] Values read(const DataPlace& place);
  /// Returns the whole numbers of a place as indices. A number out of range becomes the nearest 32-bit limit,
  /// which is not an index.
  [[nodiscard]] std::vector<Index> read_indices(const DataPlace& place);

  /// Returns the path of a file that a DataItem names. Throws InputError if the file is missing or not
  /// allowed.
  [[nodiscard]] FilePath path_of(pugi::xml_node item, const std::string& name) const;
  /// Returns the opened HDF5 files by their names in the XML.
  [[nodiscard]] const std::map<std::string, hdf5::File>& files() const noexcept { return files_; }

 private:
  /// Stores in `place` where the values of a DataItem are in an HDF5 file, and their number type.
  void find_dataset(pugi::xml_node item, DataPlace& place);
  const hdf5::File& file(pugi::xml_node item, const std::string& name);
  [[nodiscard]] Values read_text(const DataPlace& place, pugi::xml_node item) const;
  [[nodiscard]] Values read_binary(const DataPlace& place, pugi::xml_node item);

  const Document& document_;
  FilePath path_;
  std::map<std::string, hdf5::File> files_;
  std::map<std::string, std::string> binaries_;  ///< contents of binary files, by name
};

}  // namespace meshorder::xdmf
