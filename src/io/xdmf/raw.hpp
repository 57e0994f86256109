// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// XDMF files whose values are all in one HDF5 file, each dataset in one run of bytes, so that code other than
// libhdf5 can read and write them by their bytes.

#include "io/stream/file_path.hpp"
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::xdmf {

struct Layout;

/// A dataset that stores its values one after another, as they are in memory.
struct RawDataset {
  enum class Role : std::uint8_t { points, topology, array };

  Role role;
  std::string name;         ///< path in the HDF5 file
  Association association;  ///< whether a row is that of a vertex or of a cell
  std::size_t type;         ///< number type, as an alternative of Values
  Index components;         ///< of a row; of a topology, nodes of a cell
  std::int64_t rows;
  std::uint64_t place;  ///< first byte in the file
};

/// What is needed to read a file by its bytes.
struct RawGrid {
  std::vector<RawDataset> datasets;  ///< one of points, one of topology, arrays; in the order of the layout
  Shape shape = Shape::vertex;       ///< of all cells
  std::filesystem::path data;        ///< the HDF5 file
  std::shared_ptr<const Layout> layout;
};

/// Finds the bytes of the values in a file on disk. Returns nothing if only `read` understands the file, or
/// if it would note something: for several meshes, parts or HDF5 files, for sets, values in XML, chunks or
/// another byte order, for cells of several types, and for cells whose nodes a Mesh orders differently.
/// O(size of the XML + datasets).
///
/// @throws InputError as `read` for faults of the XML and of shapes; values are not looked at
std::optional<RawGrid> find_raw(const FilePath& path);

/// Returns the mark of files that are written together. `checksum`: a `Checksum` of all points, then of the
/// vertices of each cell.
std::string mark_of(std::uint64_t checksum);

/// Returns the name of the HDF5 file that belongs to a new .xdmf file, beside it.
std::string name_of_data(const Layout& layout, const std::filesystem::path& path);

/// Writes the HDF5 file of `find_raw` to a path on disk. Allocates space for the values of its datasets,
/// which the caller must then write.
///
/// @param path  of the new .xdmf file, which is not written
/// @param data  path of the new HDF5 file
/// @param mark  written to both files
/// @return the text of the new .xdmf file
/// @throws InputError if it cannot be written
std::string write_without_values(const Layout& layout, const std::filesystem::path& path,
                                 const std::filesystem::path& data, const std::string& mark);

/// Returns the first byte of the values of each dataset of `find_raw` in a file of `write_without_values`.
///
/// @param name  of the file in messages
/// @throws InputError if it cannot be read, or a dataset has no room
std::vector<std::uint64_t> places_of_values(const Layout& layout, const std::filesystem::path& data,
                                            const std::string& name);

}  // namespace meshorder::xdmf
