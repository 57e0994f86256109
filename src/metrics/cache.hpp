// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "metrics/reuse_distance.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Bytes of a cache line.
inline constexpr Offset kLineBytes = 64;

/// A model of a processor's data caches: every level is fully associative, replaces the least recently used
/// line, does not prefetch and serves one thread. Real caches are set-associative, prefetch streams and share
/// their last level.
struct Caches {
  std::vector<Offset> level_bytes;  ///< smallest first, ascending, multiples of kLineBytes

  bool operator==(const Caches&) const = default;
};

/// Parses cache sizes such as "48K,1M,32M", from the smallest level to the largest: whole numbers of bytes,
/// or of 2^10, 2^20 or 2^30 bytes with K, M or G. Throws InvalidArgument if a part of the text is not a
/// size, is not a multiple of kLineBytes or is not larger than the size before it.
Caches parse_cache_sizes(std::string_view text);

/// Returns the sizes as text that parse_cache_sizes reads, "48K,1M,32M".
std::string to_string(const Caches& caches);

/// Returns the misses of each level. For the histogram `Reuse::all` these are all misses; for `Reuse::jumps`,
/// the misses that no hardware prefetcher of streams avoids.
std::vector<Offset> misses(const ReuseHistogram& histogram, const Caches& caches);

}  // namespace meshorder
