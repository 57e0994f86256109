// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/files/file_head.hpp"

#include <optional>
#include <string>

namespace meshorder::distributed {

/// Reads the XML of a file and the tables of its compressed blocks. Returns nothing unless it is a .vtu file
/// of one piece with raw appended data in this machine's byte order, with a compression that this build
/// supports. O(size of the XML + blocks).
///
/// @param ranks  number of ranks that share the memory of uncompressed arrays
/// @throws InputError for a file of this kind that is damaged: bad XML, counts that differ, arrays beyond its
///         end, blocks whose sizes are impossible
[[nodiscard]] std::optional<FileHead> read_vtu_head(const std::string& path, int ranks);

}  // namespace meshorder::distributed
