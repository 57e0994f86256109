// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace meshorder {

/// Measures the rate in GB/s (10⁹ bytes) at which the threads together read memory: best of several passes
/// over a buffer, as STREAM does (McCalpin 1995, Memory bandwidth and machine balance in current high
/// performance computers). The buffer should be several times the last-level cache.
/// KernelBench::streamed_bytes divided by this is a lower bound on a kernel's time.
double read_bandwidth(std::size_t buffer_bytes = std::size_t{512} << 20, int passes = 8, int threads = 1);

}  // namespace meshorder
