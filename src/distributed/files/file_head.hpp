// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/layout.hpp"
#include "distributed/files/appended_arrays.hpp"
#include "io/file_layout.hpp"
#include "io/vtu.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Facts about a .vtu, .vtkhdf or .xdmf file that all ranks have.
struct FileFacts : FileSizes {
  /// A .vtkhdf file is an HDF5 file; an .xdmf file names an HDF5 file. In HDF5 files, no words precede an
  /// array.
  enum class Kind : std::uint8_t { vtu, vtkhdf, xdmf };

  Kind kind = Kind::vtu;
  Offset bytes = 0;       ///< size of the file
  Offset first_byte = 0;  ///< first byte of the appended data
  VtuEncoding encoding;
};

/// The description of a file. For a .vtu file it comes from the XML and the words before the arrays; for a
/// .vtkhdf file, and for the HDF5 file of an .xdmf file, from libhdf5.
struct FileHead {
  std::string path;  ///< path of the file that has the parts: for an .xdmf file, its HDF5 file
  FileFacts facts;
  std::vector<FilePart> parts;     ///< sorted by their first bytes
  std::vector<std::string> names;  ///< names of the parts, for messages; by part number
  std::vector<std::vector<Offset>>
      blocks;  ///< by part number: first byte of each block, then the end of the last
  VtuXml xml;
  std::string mold;                        ///< for .vtkhdf: result of `mold_of` for the file's arrays
  std::shared_ptr<const SplitFile> files;  ///< writer of an .xdmf file and its HDF5 file; else null
};

/// Returns whether the file name ends in .xdmf or .xmf.
[[nodiscard]] bool is_xdmf(const std::string& path);

/// Reads the head of a file whose arrays can be read directly. Returns nothing unless the file is one of
/// these:
/// - a .vtu file of one piece with raw appended data in this machine's byte order, with a compression that
///   this build supports. O(size of the XML + blocks);
/// - a .vtkhdf file of one partition, without chunks, another byte order, texts on points or cells, or
///   objects that the format does not define. O(datasets + size of the fields);
/// - an .xdmf file: see `xdmf::find_raw`. O(size of the XML + datasets).
///
/// @param ranks  number of ranks that share the memory of uncompressed arrays
/// @throws InputError for a damaged file: bad XML, counts or shapes that disagree, arrays beyond the end of
///         the file, blocks whose sizes are impossible, an HDF5 file that is missing or from another run
[[nodiscard]] std::optional<FileHead> read_head(const std::string& path, int ranks);

/// As `read_head`, for .vtu files.
[[nodiscard]] std::optional<FileHead> read_vtu_head(const std::string& path, int ranks);

/// Sorts parts by their first bytes. Returns whether all parts lie within a file of `bytes` bytes and no two
/// overlap. O(n log n).
[[nodiscard]] bool sort_by_bytes(std::vector<FilePart>& parts, Offset bytes);

}  // namespace meshorder::distributed
