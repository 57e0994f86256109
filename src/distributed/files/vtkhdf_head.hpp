// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/files/file_head.hpp"

#include <optional>
#include <string>

namespace meshorder::distributed {

/// Finds the arrays of a .vtkhdf file by libhdf5. Returns nothing for a file that is no HDF5 file, or whose
/// arrays cannot be read directly: with several partitions, chunks, another byte order, texts on points or
/// cells, or more than the format allows. O(datasets + size of the fields).
///
/// @throws InputError for a damaged file, whose counts or shapes disagree
[[nodiscard]] std::optional<FileHead> read_vtkhdf_head(const std::string& path);

/// Returns whether a file begins as those of HDF5 do.
[[nodiscard]] bool is_hdf5(const std::string& path);

}  // namespace meshorder::distributed
