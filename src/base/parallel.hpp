// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/run_scope.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <atomic>
#include <functional>
#include <vector>

namespace meshorder {

/// How many threads work at most: those of the machine, or the limit that is set (tbb::global_control).
[[nodiscard]] Index thread_count();

/// How many chunks of `size` make up 0 … n−1, the last one perhaps shorter.
constexpr Index chunk_count(Index n, Index size) { return static_cast<Index>((Offset{n} + size - 1) / size); }

/// Which thread takes which turns of a loop: whichever has none left, or as far as possible the one that took
/// them the last time, whose caches still hold what they work on.
enum class Sharing { balanced, repeated };

/// Calls `work(begin, end)` for ranges that make up 0 … n−1, on all threads. The ranges vary from call to
/// call.
///
/// A loop within a turn of another loop is cancelled with it, and TBB then returns from the inner one as if
/// it were done: here it throws, so that nothing goes on with what was left out.
///
/// @throws what `work` throws; Stopped within a loop that another thread has cancelled
void share_turns(Offset n, Sharing sharing, const std::function<void(Offset begin, Offset end)>& work);

/// Calls `work(i)` for 0 … n−1, on all threads. Each turn on the calling thread polls.
///
/// @throws what `work` and `poll` throw, and as `share_turns`
template <class Number, class Work>
void parallel_loop(Number n, const Work& work, Sharing sharing = Sharing::balanced) {
  const auto turns = [&](Offset begin, Offset end) {
    for (Offset i = begin; i < end; ++i) {
      poll();
      work(static_cast<Number>(i));
    }
  };
  share_turns(n, sharing, std::cref(turns));
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

/// Calls `work(i)` for 0 … n−1, on all threads: each takes the next i when it is done with one, so the
/// longest turns should come first. For few turns of a millisecond and more; each polls on the calling
/// thread.
///
/// @throws as `parallel_loop`; turns that have not begun by then are left out
template <class Work>
void take_turns(Index n, const Work& work) {
  std::atomic<Index> next = 0;
  parallel_loop(std::min(n, thread_count()), [&](Index /*thread*/) {
    for (Index i = next++; i < n; i = next++) {
      try {
        poll();
        work(i);
      } catch (...) {
        next = n;
        throw;
      }
    }
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
/// possible the same as the last time.
template <class Work>
void for_each_part(Index parts, Work work) {
  parallel_loop(parts, work, Sharing::repeated);
}

/// Calls `work(begin, end)` for the ranges of `size` that make up 0 … n−1, on all threads. The ranges do not
/// depend on the number of threads. As for_each_chunk, for more than 2³¹ entries.
template <class Work>
void for_each_range(Offset n, Offset size, const Work& work) {
  if (n <= size) {
    if (n > 0) work(Offset{0}, n);
    return;
  }
  parallel_loop((n + size - 1) / size,
                [&](Offset range) { work(range * size, std::min(n, (range + 1) * size)); });
}

}  // namespace meshorder
