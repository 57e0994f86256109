// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <vector>

namespace meshorder {

/// Counts the bytes that a cache fetches from memory while a kernel reads records of an array, and streams
/// through other arrays. The accesses are cut into windows; in each window the cache is filled once. A sector
/// of 32 bytes is fetched once in each window that touches it.
class CacheWindows {
 public:
  static constexpr Offset kSectorBytes = 32;

  /// @param array_bytes  size of the array of records
  /// @param alike        number of arrays of this size; `touch` reads the same record of each; ≥ 1
  /// @param cache_bytes  size of the cache, ≥ 1
  CacheWindows(Offset array_bytes, int alike, Offset cache_bytes)
      : window_of_(static_cast<std::size_t>(array_bytes / kSectorBytes) + 1, -1),
        fetch_(alike * kSectorBytes),
        cache_bytes_(cache_bytes) {}

  /// Reads bytes that nothing reads again. O(1).
  void stream(Offset bytes) {
    bytes_ += bytes;
    filled_ += bytes;
    if (filled_ < cache_bytes_) return;
    ++window_;
    filled_ = 0;
  }

  /// Reads record `number` of each array; a record has `size` bytes, 1 … 32. O(1).
  void touch(Offset number, int size) {
    const Offset first = number * size / kSectorBytes;
    const Offset last = (number * size + size - 1) / kSectorBytes;
    fetch(first);
    if (last != first) fetch(last);
  }

  /// Returns the bytes fetched so far.
  [[nodiscard]] Offset bytes() const { return bytes_; }

 private:
  void fetch(Offset sector) {
    Index& window = window_of_[static_cast<std::size_t>(sector)];
    if (window == window_) return;
    window = window_;
    stream(fetch_);
  }

  std::vector<Index> window_of_;  ///< the latest window in which each sector was fetched; −1: none
  Offset fetch_;
  Offset cache_bytes_;
  Index window_ = 0;
  Offset filled_ = 0;  ///< bytes fetched in this window
  Offset bytes_ = 0;
};

}  // namespace meshorder
