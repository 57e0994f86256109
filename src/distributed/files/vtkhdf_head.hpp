// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/files/file_head.hpp"

#include <optional>
#include <string>

namespace meshorder::distributed {

/// Asks libhdf5 where the arrays of a .vtkhdf file are. Returns nothing for a file that is none of HDF5, or
/// whose arrays cannot be read by their bytes: of several partitions, chunked, in another order of bytes,
/// with texts on points or cells, or with more than the format has. O(datasets + size of the fields).
///
/// @throws InputError for a file that is damaged: counts and shapes that differ
[[nodiscard]] std::optional<FileHead> read_vtkhdf_head(const std::string& path);

/// Returns whether a file begins as those of HDF5 do.
[[nodiscard]] bool is_hdf5(const std::string& path);

}  // namespace meshorder::distributed
