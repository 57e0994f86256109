// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/scanner.hpp"

#include <cstddef>
#include <functional>

namespace meshorder {

/// Reads the next records of a text, each on a line of its own, on all threads, as far as they are regular.
/// Returns how many it read; the scanner is then after the last one. The caller reads the others one by one:
/// it reports their errors and accepts what is unusual but valid. So errors and results are those of a reader
/// that reads all records one by one.
///
/// The text is divided at line ends into parts. The number of lines with a word in each part gives the first
/// record of the next.
///
/// @param in     is after all text that precedes the first record, on its line or before
/// @param count  the most records to read, ≥ 0
/// @param read   `read(part, record)` takes the words of a record; returns false if the record is not
///              regular. It writes only data of the record, and may be called again for the same record. A
///              record is also not regular if `read` throws an Error, or if more words follow on its line
/// @param part_bytes  least size of a part, > 0
/// @note O(bytes); memory: a few numbers for each part.
Index read_regular_records(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                           std::size_t part_bytes = std::size_t{1} << 20);

}  // namespace meshorder
