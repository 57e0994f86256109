// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace meshorder {

/// The latency of dependent loads (each waits for the load before it) at random lines within the first
/// `bytes` bytes.
struct ProbePoint {
  Offset bytes = 0;
  double nanoseconds = 0;

  bool operator==(const ProbePoint&) const = default;
};

/// A cache level found from measured latencies.
struct FoundCache {
  Offset bytes = 0;        ///< size available to one thread, in whole KiB
  double nanoseconds = 0;  ///< latency of a load that hits it

  bool operator==(const FoundCache&) const = default;
};

/// The caches, the smallest first, and the memory.
struct FoundCaches {
  std::vector<FoundCache> levels;
  double memory_nanoseconds = 0;  ///< latency of a load that misses all levels

  bool operator==(const FoundCaches&) const = default;
};

/// Returns the sizes at which to probe: three in each doubling from 8 KiB to `largest` bytes.
std::vector<Offset> probe_sizes(Offset largest);

/// Measures the time of dependent loads at random lines within the first `sizes[i]` bytes of a buffer, for
/// each i. Returns the least of `rounds` runs at each size. Each round runs over all sizes, so that a short
/// disturbance does not fall on one size only. The buffer is on large pages if the system has them. `tell`
/// receives the share of the work that is done, 0 … 1.
std::vector<ProbePoint> probe_latencies(std::span<const Offset> sizes, int rounds,
                                        const std::function<void(double)>& tell = {});

/// Finds the caches from latencies at ascending sizes. A share 1 − c/s of random loads within s bytes misses
/// a cache of c < s bytes. So the latency is a + Σ d · max(0, 1 − c/s), summed over levels of c bytes whose
/// miss costs d more than a hit. Chooses at most `most` of the points' sizes as levels, such that the sum of
/// squared relative errors is least (a, d ≥ 0). Sizes are returned in whole KiB. One more level must reduce
/// that error by more than a quarter. Returns at least one level: the largest size if latencies do not rise.
/// O(n^(most+1)) for n points. Throws InvalidArgument without points.
FoundCaches find_caches(std::span<const ProbePoint> points, std::size_t most = 3);

/// Measures the rate, in GB/s (10⁹ bytes), at which the threads together read memory. Returns the best of
/// several passes over a buffer, as STREAM does (McCalpin 1995, Memory bandwidth and machine balance in
/// current high performance computers). The buffer should be several times the last-level cache.
/// KernelBench::streamed_bytes divided by this rate is a lower bound on a kernel's time.
double read_bandwidth(std::size_t buffer_bytes = std::size_t{512} << 20, int passes = 8, int threads = 1);

}  // namespace meshorder
