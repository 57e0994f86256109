// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace meshorder {

/// The rate in GB/s (10⁹ bytes) at which so many threads together read memory: the best of several passes
/// over a buffer, as STREAM measures (McCalpin 1995). The buffer should be several times the last-level
/// cache. Divides KernelBench::streamed_bytes into a kernel's least time.
double read_bandwidth(std::size_t buffer_bytes = std::size_t{512} << 20, int passes = 8, int threads = 1);

}  // namespace meshorder
