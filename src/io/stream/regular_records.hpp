// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "io/stream/scanner.hpp"

#include <cstddef>
#include <functional>

namespace meshorder {

/// Reads the next records of a text, one on a line of its own, on all threads, as far as they are regular.
/// Returns how many it read; the scanner then is after the last one. The caller reads the others one after
/// another: it says what is wrong with them, and takes what is unusual but right. So errors and results are
/// those of a reader that does all records itself.
///
/// The text is divided at line ends into parts. Lines with something on them are counted, so
/// that each part knows its first record.
///
/// @param in     is anywhere before the first record, after what comes before it
/// @param count  ≥ 0, at most so many
/// @param read   `read(part, record)` takes the words of a record; false: it is not regular, which it is not
///               either where more words follow on its line. It writes only what belongs to the record, and
///               may be called again for it. Errors make a record irregular
/// @param part_bytes  of a part, at least, > 0
/// @note O(bytes); a few numbers for each part.
Index read_regular_records(Scanner& in, Index count, const std::function<bool(Scanner&, Index)>& read,
                           std::size_t part_bytes = std::size_t{1} << 20);

}  // namespace meshorder
