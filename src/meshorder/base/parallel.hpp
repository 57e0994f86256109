// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/base/index.hpp>

#include <tbb/parallel_for.h>

#include <algorithm>

namespace meshorder {

/// Calls `work(chunk, begin, end)` for the chunks of `size` that make up 0 … n−1, on all threads. The chunks
/// do not depend on the number of threads, so neither does what is computed chunk by chunk.
template <class Work>
void for_each_chunk(Index n, Index size, Work work) {
  const auto chunks = static_cast<Index>((Offset{n} + size - 1) / size);
  tbb::parallel_for(Index{0}, chunks, [&](Index chunk) {
    const Index begin = chunk * size;
    work(chunk, begin, static_cast<Index>(std::min(Offset{begin} + size, Offset{n})));
  });
}

}  // namespace meshorder
