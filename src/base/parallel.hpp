// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/run_scope.hpp"
#include <meshorder/error.hpp>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <vector>

namespace meshorder {

/// How many threads work at most: those of the machine, or the limit that is set (tbb::global_control).
inline Index thread_count() {
  const std::size_t limit = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(static_cast<Index>(limit), Index{tbb::this_task_arena::max_concurrency()});
}

/// How many chunks of `size` make up 0 … n−1, the last one perhaps shorter.
constexpr Index chunk_count(Index n, Index size) { return static_cast<Index>((Offset{n} + size - 1) / size); }

/// Calls `work(i)` for 0 … n−1, on all threads. Each turn on the calling thread polls.
///
/// A loop within a turn of another loop is cancelled with it, and TBB then returns from the inner one as if
/// it were done: here it throws, so that nothing goes on with what was left out.
///
/// @throws what `work` and `poll` throw; Stopped within a loop that another thread has cancelled
template <class Number, class Work, class... Partitioner>
void parallel_loop(Number n, const Work& work, const Partitioner&... partitioner) {
  tbb::task_group_context context;
  tbb::parallel_for(
      Number{0}, n,
      [&](Number i) {
        poll();
        work(i);
      },
      partitioner..., context);
  if (context.is_group_execution_cancelled()) throw Stopped();
}

/// Calls `work(chunk, begin, end)` for the chunks of `size` that make up 0 … n−1, on all threads. The chunks
/// do not depend on the number of threads, so neither does what is computed chunk by chunk.
template <class Work>
void for_each_chunk(Index n, Index size, Work work) {
  const Index chunks = chunk_count(n, size);
  if (chunks <= 1) {
    if (n > 0) work(Index{0}, Index{0}, n);
    return;
  }
  parallel_loop(chunks, [&](Index chunk) {
    const Index begin = chunk * size;
    work(chunk, begin, static_cast<Index>(std::min(Offset{begin} + size, Offset{n})));
  });
}

/// The sum of `part(begin, end)` over the chunks, added up in their order, so that the result is the same for
/// any number of threads. `Sum` needs a zero by `Sum{}` and +=.
template <class Sum, class Part>
Sum sum_over_chunks(Index n, Index size, Part part) {
  std::vector<Sum> parts(chunk_count(n, size));
  for_each_chunk(n, size, [&](Index chunk, Index begin, Index end) { parts[chunk] = part(begin, end); });
  Sum sum{};
  for (const Sum& p : parts) sum += p;
  return sum;
}

/// Calls `work(part)` for 0 … parts−1, each on a thread of its own as far as there are threads, and as far as
/// possible the same as the last time, whose caches still hold what the part works on.
template <class Work>
void for_each_part(Index parts, Work work) {
  parallel_loop(parts, work, tbb::static_partitioner());
}

}  // namespace meshorder
