// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/files/file_head.hpp"
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <string_view>
#include <vector>

namespace meshorder::distributed {

/// Returns a description of an array whose values are contiguous in an HDF5 file, without words before them.
///
/// @param name  its first 40 bytes are kept
/// @param type  number type: index of an alternative of Values
/// @param row   numbers per row
/// @param at    first byte in the file
[[nodiscard]] FileArray raw_array(std::string_view name, FileArray::Role role, Association association,
                                  std::size_t type, Offset row, Offset rows, Offset at);

/// Sorts arrays by their first bytes. Returns whether all are within a file of so many bytes and no two
/// overlap. O(n log n).
[[nodiscard]] bool sort_by_bytes(std::vector<FileArray>& arrays, Offset bytes);

}  // namespace meshorder::distributed
