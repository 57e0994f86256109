// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/polymorphic.hpp"
#include "mesh/values.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/shape.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace meshorder {

/// A part of a file: rows of numbers, their meaning, and the bytes that hold them.
struct FilePart {
  enum class Role : std::uint8_t { points, types, offsets, connectivity, data, members };

  Role role = Role::data;
  Association association = Association::vertices;  ///< whether a row belongs to a vertex or to a cell
  std::uint8_t type = 0;                            ///< number type: index of an alternative of Values
  Index components = 1;                             ///< numbers in a row
  std::int64_t rows = 0;                            ///< number of rows; for the connectivity, its length
  std::size_t number = 0;                           ///< index in FileLayout::names of the part's name
  std::int64_t at = 0;      ///< byte offset of the size words, or of the values if there are no size words
  std::int64_t stored = 0;  ///< bytes in the file, including the size words
  std::int64_t blocks = 0;  ///< number of compressed blocks; 0: not compressed
  std::int64_t block = 0;   ///< uncompressed bytes of a block; the last block may be smaller

  /// Returns the bytes of a row, uncompressed.
  [[nodiscard]] std::int64_t row_size() const { return components * size_of_type(type); }
  /// Returns the bytes of all rows, uncompressed.
  [[nodiscard]] std::int64_t size() const { return rows * row_size(); }
};

/// Sizes of the mesh in a file.
struct FileSizes {
  std::int64_t vertices = 0;
  std::int64_t cells = 0;
  std::int64_t entries = 0;  ///< length of the connectivity
  // used only if the file has no types and offsets of cells
  Shape shape = Shape::vertex;  ///< shape of all cells
  std::int64_t nodes = 0;       ///< number of vertices of each cell
};

/// A file as a list of parts, for code that reads and writes their bytes directly.
struct FileLayout : FileSizes {
  std::vector<FilePart> parts;
  std::vector<std::string> names;  ///< indexed by FilePart::number
};

/// Makes the two files of a mesh: a document, and a data file that the document names.
class SplitFile : public Polymorphic {
 public:
  /// Returns the path of the data file for a new document.
  [[nodiscard]] virtual std::string data_of(const std::string& document) const = 0;

  /// Writes the data file `data` on disk. Allocates space for the values of all parts; the caller must then
  /// write the values.
  ///
  /// @param document  path of the new document; the caller writes it
  /// @param checksum  mark to write into both files: `Checksum` of all points, then of each cell's vertices
  /// @return the text of the document
  /// @throws InputError if the data cannot be written
  [[nodiscard]] virtual std::string write_without_values(const std::string& document, const std::string& data,
                                                         std::uint64_t checksum) const = 0;

  /// Returns the byte offsets of the parts, by FilePart::number, in a data file of `write_without_values`.
  ///
  /// @param name  name of the data file in messages
  /// @throws InputError if the data file cannot be read, or lacks space for a part
  [[nodiscard]] virtual std::vector<std::int64_t> places_in(const std::string& data,
                                                            const std::string& name) const = 0;
};

}  // namespace meshorder
