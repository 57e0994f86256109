// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// XDMF files whose values are all in one HDF5 file, those of a dataset one after another, so that code other
// than libhdf5 can read and write them by their bytes.

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

/// A dataset whose values are in the file as they are in memory, one after another.
struct RawDataset {
  enum class Role : std::uint8_t { points, topology, array };

  Role role;
  std::string name;         ///< path in the HDF5 file
  Association association;  ///< of what has its rows
  std::size_t type;         ///< number type, as an alternative of Values
  Index components;         ///< of a row; of a topology, nodes of a cell
  std::int64_t rows;
  std::uint64_t place;  ///< first byte in the file
};

/// What there is to know of a file to read it by its bytes.
struct RawGrid {
  std::vector<RawDataset> datasets;  ///< one of points, one of topology, arrays; in the order of the layout
  Shape shape = Shape::vertex;       ///< of all cells
  std::filesystem::path data;        ///< the HDF5 file
  std::shared_ptr<const Layout> layout;
};

/// Finds where the values of a file on disk are. Returns nothing for one that only `read` understands, or of
/// which it would note something: of several meshes, parts or HDF5 files, with sets, values in XML, chunks or
/// another order of bytes, with cells of several types, or with such whose nodes a Mesh has in another order.
/// O(size of the XML + datasets).
///
/// @throws InputError as `read` for faults of the XML and of shapes; values are not looked at
std::optional<RawGrid> find_raw(const FilePath& path);

/// Returns what marks both files as written together, for a `Checksum` of all points and then, each as a
/// range, of the cells.
std::string mark_of(std::uint64_t checksum);

/// Returns the name of the HDF5 file that belongs to a new .xdmf file, beside it.
std::string name_of_data(const Layout& layout, const std::filesystem::path& path);

/// Writes the HDF5 file of `find_raw` anew, over one on disk, but without the values of its datasets: these
/// have room, and whoever writes them has to fill it.
///
/// @param path  of the new .xdmf file, which is not written
/// @param data  of the HDF5 file
/// @param mark  that both files get
/// @return the new .xdmf file
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
