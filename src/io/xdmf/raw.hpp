// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// XDMF files whose values are all in one HDF5 file, each dataset in one run of bytes. Code other than libhdf5
// can then read and write the bytes of the values.

#include "io/file_layout.hpp"
#include "io/stream/file_path.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace meshorder::xdmf {

/// A file as a list of parts: points, connectivity and arrays. A part's name is its path in the HDF5 file.
struct RawGrid {
  FileLayout layout;
  std::string data;  ///< path of the HDF5 file
  std::shared_ptr<const SplitFile> files;
};

/// Finds the bytes of the values in a file on disk. Returns nullopt if only `read` understands the file, or
/// if `read` would note something: for several meshes, parts or HDF5 files, sets, values in XML, chunks or
/// another byte order, cells of several types, and cells whose nodes a Mesh orders differently.
/// O(size of the XML + datasets).
///
/// @throws InputError as `read` for faults of the XML and of shapes; the values of parts are not read
std::optional<RawGrid> find_raw(const FilePath& path);

/// Returns the mark of files that are written together. `checksum`: a `Checksum` of all points, then of the
/// vertices of each cell.
std::string mark_of(std::uint64_t checksum);

}  // namespace meshorder::xdmf
