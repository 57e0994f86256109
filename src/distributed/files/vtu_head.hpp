// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/files/file_head.hpp"

#include <optional>
#include <string>

namespace meshorder::distributed {

/// Reads the XML of a file and the tables of its compressed blocks. Returns nothing for a file that is no
/// .vtu file of one piece with raw appended data in this machine's order of bytes, and for one whose
/// compression this build lacks. O(size of the XML + blocks).
///
/// @param ranks  number of ranks that share the memory of uncompressed arrays
/// @throws InputError for a file of that kind that is damaged: XML, counts that differ, bytes beyond its end,
///         blocks that cannot hold what they are said to
[[nodiscard]] std::optional<FileHead> read_vtu_head(const std::string& path, int ranks);

}  // namespace meshorder::distributed
