// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/files/file_head.hpp"
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <string_view>
#include <vector>

namespace meshorder::distributed {

/// Returns an array whose values are in a file of HDF5, one after another, and without words before them.
///
/// @param name  of which the first 40 bytes are kept
/// @param type  number type, as an alternative of Values
/// @param row   numbers of a row
/// @param at    first byte in the file
[[nodiscard]] FileArray raw_array(std::string_view name, FileArray::Role role, Association association,
                                  std::size_t type, Offset row, Offset rows, Offset at);

/// Puts arrays into the order of their bytes. Returns whether all are within a file of so many bytes, and no
/// two share any. O(n log n).
[[nodiscard]] bool sort_by_bytes(std::vector<FileArray>& arrays, Offset bytes);

}  // namespace meshorder::distributed
