// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "metrics/reuse_distance.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Bytes that caches move at a time.
inline constexpr Offset kLineBytes = 64;

/// A model of a processor's data caches: each level holds the most recently used lines, wherever they lie in
/// memory, fetches nothing ahead and belongs to one thread. Real caches map lines to sets, fetch streams
/// ahead and share their last level.
struct Caches {
  std::vector<Offset> level_bytes;  ///< from the smallest; rising, multiples of kLineBytes

  bool operator==(const Caches&) const = default;
};

/// Those of this machine's first processor, as Linux or the C library tells them; 32K, 512K and 16M where
/// neither does.
Caches caches_of_this_machine();

/// Those of the Intel Xeon E5-1620 v4, on which the paper measured: 32 KB, 256 KB and 10 MB.
Caches caches_of_the_paper();

/// "this" or "" for this machine's, "paper" for the paper's, or the sizes of the levels, "48K,1M,32M": whole
/// numbers of bytes, or of 2^10, 2^20 or 2^30 of them with K, M or G. Throws InvalidArgument where the sizes
/// are none, do not rise or do not hold whole lines.
Caches parse_caches(std::string_view text);

/// "48K,1M,32M", which parse_caches reads.
std::string to_string(const Caches& caches);

/// The misses of each level, when the histogram is a `Reuse`'s `all`; when it is its `jumps`, those misses
/// that no stream leads to.
std::vector<Offset> misses(const ReuseHistogram& histogram, const Caches& caches);

}  // namespace meshorder
