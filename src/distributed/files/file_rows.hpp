// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/shared_file.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// Reads bytes begin … end − 1 of the values of an array, others on each rank; of compressed ones the blocks
/// that they are in. Every rank has to call it. O(bytes + size of a block), O(blocks) at the root.
///
/// @param name    of the file in messages
/// @param blocks  at the root: first byte of each block in the file, and the last one's end; not looked at
///                elsewhere, nor where the file is not compressed
/// @throws SharedError where a rank cannot read or a block does not hold what it should
[[nodiscard]] std::vector<std::byte> read_values(const Communicator& communicator, const SharedFile& file,
                                                 const std::string& name, VtuEncoding::Compressor compressor,
                                                 const FileArray& array, const std::vector<Offset>& blocks,
                                                 Offset begin, Offset end);

/// Writes an array with the words before it, raw or in blocks that do not depend on the number of ranks.
/// Every rank has to call it. O(bytes).
///
/// @param at      first byte in the file
/// @param values  of this rank, which go on on the next one; taken
/// @param block   bytes of a block, ≥ 1
/// @return how many bytes of the file the array takes, the same on all ranks
/// @throws SharedError where a rank cannot write
Offset write_values(const Communicator& communicator, const SharedFile& file, const VtuEncoding& encoding,
                    Offset at, std::vector<std::byte> values, Offset block);

/// Writes an array without words before it; as `write_values`.
Offset write_raw(const Communicator& communicator, const SharedFile& file, Offset at,
                 std::span<const std::byte> values);

}  // namespace meshorder::distributed
