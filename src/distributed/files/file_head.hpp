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

/// An array of a .vtu, .vtkhdf or .xdmf file: what it holds, and where its values are.
struct FileArray {
  enum class Role : std::uint8_t { points, types, offsets, connectivity, data };

  std::array<char, 41> name;  ///< or how it begins, for messages; ends with a zero
  std::size_t element = 0;    ///< which one of the arrays of the piece in the XML, from 0 on
  Role role;
  Association association;
  std::uint8_t type;  ///< number type, as the alternatives of Values
  Offset at;          ///< first byte in the file, of the words before the values
  Offset stored;      ///< bytes in the file, those words among them
  Offset row;         ///< bytes of a row
  Offset size;        ///< bytes of all rows
  Offset blocks;      ///< in which they are compressed; 0: they are not
  Offset block;       ///< bytes of a block, but for the last one, which has the rest
};

/// What all ranks know of a .vtu, .vtkhdf or .xdmf file.
struct FileFacts {
  /// In the files of HDF5 that the last two are, arrays have no words before them, and there is no XML.
  enum class Kind : std::uint8_t { vtu, vtkhdf, xdmf };

  Kind kind = Kind::vtu;
  GlobalIndex vertices = 0;
  GlobalIndex cells = 0;
  GlobalIndex entries = 0;  ///< of the connectivity
  Offset bytes = 0;         ///< size of the file
  Offset first_byte = 0;    ///< of the appended data
  VtuEncoding encoding;
  // of an .xdmf file, which has no arrays of types and offsets
  Shape shape = Shape::vertex;  ///< of all cells
  Offset nodes = 0;             ///< of each cell
};

/// What the XML of a .vtu file says, and the words before its arrays; or what libhdf5 says of a .vtkhdf file,
/// or of the HDF5 file of an .xdmf file.
struct FileHead {
  FileFacts facts;
  std::vector<FileArray> arrays;  ///< in the order of their bytes
  std::vector<std::vector<Offset>>
      blocks;  ///< of each array: first byte of each block, and the last one's end
  VtuXml xml;
  std::string mold;                            ///< of a .vtkhdf file: what `mold_of` makes of its arrays
  std::string data;                            ///< path of an .xdmf file's HDF5 file
  std::shared_ptr<const xdmf::Layout> layout;  ///< of an .xdmf file, whose fields are the elements of arrays
};

}  // namespace meshorder::distributed
