// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/files/file_head.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Returns whether the name of a file is that of an XDMF file.
[[nodiscard]] bool is_xdmf(const std::string& path);

/// Reads an .xdmf file and finds the arrays of its HDF5 file by libhdf5. Returns nothing for a file whose
/// arrays cannot be read directly: see `xdmf::find_raw`. O(size of the XML + datasets).
///
/// @throws InputError for a damaged file, and if its HDF5 file is missing or from another run
[[nodiscard]] std::optional<FileHead> read_xdmf_head(const std::string& path);

/// Returns the path of the HDF5 file that belongs to a new .xdmf file.
[[nodiscard]] std::string new_data_of_xdmf(const FileHead& head, const std::string& path);

/// Overwrites an HDF5 file on disk with a new one that has room for all arrays; returns the new .xdmf text.
///
/// @param name      of the new .xdmf file
/// @param data      path of the HDF5 file
/// @param checksum  of the new points and cells; see `xdmf::mark_of`
/// @throws InputError if it cannot be written
[[nodiscard]] std::string write_xdmf_head(const FileHead& head, const std::string& name,
                                          const std::string& data, std::uint64_t checksum);

/// Returns the first byte of each array of a file of `write_xdmf_head`, indexed by FileArray::element.
///
/// @param name  of the .xdmf file
/// @param data  path of its HDF5 file
/// @throws InputError if it cannot be read
[[nodiscard]] std::vector<Offset> places_in_xdmf(const FileHead& head, const std::string& name,
                                                 const std::string& data);

}  // namespace meshorder::distributed
