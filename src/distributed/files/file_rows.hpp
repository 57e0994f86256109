// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/comm/layout.hpp"
#include "distributed/comm/moved_rows.hpp"
#include "distributed/files/shared_file.hpp"
#include "io/file_layout.hpp"
#include "io/vtu.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// The names, for messages, of a part and of its file.
struct PartName {
  const std::string& file;
  const std::string& part;
};

/// Returns the values that move to this rank's places; `values` has a value for each row of this rank. Every
/// rank has to call it. O(values). Throws as `RowMover::moved`.
template <class Value>
[[nodiscard]] std::vector<Value> moved_values(const Communicator& communicator, const RowMover& mover,
                                              const std::vector<Value>& values) {
  const std::vector<std::byte> bytes = mover.moved(std::as_bytes(std::span(values)), Offset{sizeof(Value)});
  return communicator.together([&] {
    std::vector<Value> moved(bytes.size() / sizeof(Value));
    std::copy(bytes.begin(), bytes.end(), std::as_writable_bytes(std::span(moved)).begin());
    return moved;
  });
}

/// Reads bytes begin … end − 1 of the values of an array; each rank has its own range. If the array is
/// compressed, reads whole blocks. Every rank has to call it. O(bytes + size of a block) time; at the root
/// also O(blocks).
///
/// @param blocks  at the root: first byte of each block in the file, then the end of the last. Ignored on
///                other ranks, and on all ranks if the file is not compressed
/// @throws SharedError if a rank cannot read or uncompress a block
[[nodiscard]] std::vector<std::byte> read_values(const Communicator& communicator, const SharedFile& file,
                                                 const PartName& name, VtuEncoding::Compressor compressor,
                                                 const FilePart& array, const std::vector<Offset>& blocks,
                                                 Offset begin, Offset end);

/// Writes an array with the words before it, raw or in compressed blocks that do not depend on the number of
/// ranks. Every rank has to call it. O(bytes).
///
/// @param at      first byte in the file
/// @param values  this rank's range of the array's bytes; ranges follow in rank order
/// @param block   uncompressed bytes of a block, ≥ 1
/// @return number of bytes that the array takes in the file, the same on all ranks
/// @throws SharedError if a rank cannot write
Offset write_values(const Communicator& communicator, const SharedFile& file, const VtuEncoding& encoding,
                    Offset at, std::vector<std::byte> values, Offset block);

/// As `write_values`, but always raw and without words before the array.
Offset write_raw(const Communicator& communicator, const SharedFile& file, Offset at,
                 std::span<const std::byte> values);

}  // namespace meshorder::distributed
