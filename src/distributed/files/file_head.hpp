// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/layout.hpp"
#include "distributed/files/vtu_offsets.hpp"
#include "io/format.hpp"
#include "io/vtu.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/shape.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace meshorder::xdmf {
struct Layout;
}

namespace meshorder::distributed {

/// An array of a .vtu, .vtkhdf or .xdmf file: its contents, and where its values are.
struct FileArray {
  enum class Role : std::uint8_t { points, types, offsets, connectivity, data };

  std::array<char, 41> name;  ///< its first 40 bytes, for messages; ends with a zero
  std::size_t element = 0;    ///< place among the arrays of the piece in the XML, from 0 on
  Role role;
  Association association;
  std::uint8_t type;  ///< number type: index of an alternative of Values
  Offset at;          ///< first byte in the file, of the words (sizes) before the values
  Offset stored;      ///< bytes in the file, including those words
  Offset row;         ///< bytes of a row
  Offset size;        ///< bytes of all rows, uncompressed
  Offset blocks;      ///< number of compressed blocks; 0: not compressed
  Offset block;       ///< uncompressed bytes of a block; the last block has the rest
};

/// Facts on a .vtu, .vtkhdf or .xdmf file that all ranks have.
struct FileFacts {
  /// A .vtkhdf file is an HDF5 file, an .xdmf file has one. Their arrays have no words before them.
  enum class Kind : std::uint8_t { vtu, vtkhdf, xdmf };

  Kind kind = Kind::vtu;
  GlobalIndex vertices = 0;
  GlobalIndex cells = 0;
  GlobalIndex entries = 0;  ///< length of the connectivity
  Offset bytes = 0;         ///< size of the file
  Offset first_byte = 0;    ///< first byte of the appended data
  VtuEncoding encoding;
  // only of an .xdmf file, which has no arrays of types and offsets
  Shape shape = Shape::vertex;  ///< of all cells
  Offset nodes = 0;             ///< of each cell
};

/// The description of a file: from the XML of a .vtu file and the words before its arrays; or from libhdf5,
/// of a .vtkhdf file or of the HDF5 file of an .xdmf file.
struct FileHead {
  FileFacts facts;
  std::vector<FileArray> arrays;  ///< sorted by their place in the file
  std::vector<std::vector<Offset>>
      blocks;  ///< of each array: first byte of each block, then the end of the last
  VtuXml xml;
  std::string mold;                            ///< of a .vtkhdf file: result of `mold_of` for its arrays
  std::string data;                            ///< of an .xdmf file: path of its HDF5 file
  std::shared_ptr<const xdmf::Layout> layout;  ///< of an .xdmf file; FileArray::element refers to its fields
};

}  // namespace meshorder::distributed
