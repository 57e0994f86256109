// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace meshorder {

/// What a load takes that waits for the one before, at a random line of so many bytes.
struct ProbePoint {
  Offset bytes = 0;
  double nanoseconds = 0;

  bool operator==(const ProbePoint&) const = default;
};

/// A cache as a program finds it.
struct FoundCache {
  Offset bytes = 0;        ///< what one thread gets of it, in whole KiB
  double nanoseconds = 0;  ///< of a load that finds its line there

  bool operator==(const FoundCache&) const = default;
};

/// The caches, the smallest first, and the memory.
struct FoundCaches {
  std::vector<FoundCache> levels;
  double memory_nanoseconds = 0;  ///< of a load that finds its line in none

  bool operator==(const FoundCaches&) const = default;
};

/// Returns the sizes at which to probe: three in each doubling from 8 KiB to `largest` bytes.
std::vector<Offset> probe_sizes(Offset largest);

/// Measures the time of dependent loads at random lines of a buffer, for each of its first so many bytes,
/// ascending: the least of `rounds` runs at each size, in rounds over all sizes, so that what disturbs a
/// moment does not fall on one size. The memory of the buffer is on large pages where the system has them.
/// `tell` receives the share that is done.
std::vector<ProbePoint> probe_latencies(std::span<const Offset> sizes, int rounds,
                                        const std::function<void(double)>& tell = {});

/// Finds the caches from latencies at ascending sizes. Random loads within s bytes miss a cache of c < s
/// bytes in the share 1 − c/s of all cases, so that the latency is a + Σ d · max(0, 1 − c/s) for levels of c
/// bytes that cost d more to miss than to hit. Of all choices of at most `most` sizes, in whole KiB, the one
/// is taken whose relative errors are least (by non-negative least squares for a and d); a level more only
/// where it explains a quarter of what is left. At least one; where nothing rises it is the largest size.
/// O(n^most) for n points.
FoundCaches find_caches(std::span<const ProbePoint> points, std::size_t most = 3);

}  // namespace meshorder
