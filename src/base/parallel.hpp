// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/run_scope.hpp"
#include <meshorder/error.hpp>
#include <meshorder/options.hpp>

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace meshorder {

/// Returns the largest number of threads that work: those of the current arena, up to the limit of
/// tbb::global_control.
[[nodiscard]] Index thread_count();

/// Returns the number of chunks of `size` that make up 0 … n−1; the last one may be shorter.
constexpr Index chunk_count(Index n, Index size) { return static_cast<Index>((Offset{n} + size - 1) / size); }

/// How threads share the turns (iterations) of a loop. balanced: a thread without work takes turns from
/// another. repeated: a thread takes the same turns as last time if possible: their data may still be in its
/// caches.
enum class Sharing { balanced, repeated };

/// Calls `work(begin, end)` for ranges that make up 0 … n−1, on all threads. The ranges vary from call to
/// call.
///
/// If TBB cancels an outer loop, it also cancels loops within the turns of that loop; TBB's loops then return
/// as if complete. This function throws Stopped instead, so that nothing uses incomplete results.
///
/// @throws what `work` throws; Stopped within a loop that another thread has cancelled
void share_turns(Offset n, Sharing sharing, const std::function<void(Offset begin, Offset end)>& work);

/// Calls `work(i)` for 0 … n−1, on all threads. Each turn calls `poll` first.
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
/// do not depend on the number of threads, so results that are computed chunk by chunk do not either.
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

/// Calls `work(i)` for 0 … n−1, on all threads. Each thread takes the next i when it has finished one, so the
/// longest turns should come first. Meant for few turns that take a millisecond or more. Each turn calls
/// `poll` first.
///
/// @throws as `parallel_loop`; after an exception, no further turn begins
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

/// Returns the sum of `part(begin, end)` over the chunks of `size`, added in ascending order: the same for
/// any number of threads. `Sum{}` must be zero, and `Sum` needs +=.
template <class Sum, class Part>
Sum sum_over_chunks(Index n, Index size, Part part) {
  std::vector<Sum> parts(chunk_count(n, size));
  for_each_chunk(n, size, [&](Index chunk, Index begin, Index end) { parts[chunk] = part(begin, end); });
  Sum sum{};
  for (const Sum& p : parts) sum += p;
  return sum;
}

/// Calls `work(part)` for 0 … parts−1, each on a thread of its own if there are enough threads, and if
/// possible on the same thread as last time.
template <class Work>
void for_each_part(Index parts, Work work) {
  parallel_loop(parts, work, Sharing::repeated);
}

/// Calls `work(begin, end)` for the ranges of `size` that make up 0 … n−1, on all threads. The ranges do not
/// depend on the number of threads. Like for_each_chunk, but n may exceed 2³¹.
template <class Work>
void for_each_range(Offset n, Offset size, const Work& work) {
  if (n <= size) {
    if (n > 0) work(Offset{0}, n);
    return;
  }
  parallel_loop((n + size - 1) / size,
                [&](Offset range) { work(range * size, std::min(n, (range + 1) * size)); });
}

/// Returns whether `holds(begin, end)` is true for all of the ranges that make up 0 … n−1. On all threads.
template <class Holds>
bool holds_for_all(Offset n, const Holds& holds) {
  constexpr Offset kAtOnce = 65536;
  std::atomic<bool> all = true;
  for_each_range(n, kAtOnce, [&](Offset begin, Offset end) {
    if (all.load(std::memory_order_relaxed) && !holds(begin, end))
      all.store(false, std::memory_order_relaxed);
  });
  return all;
}

/// Calls `work()` in a TBB arena of its own with as many threads as `run` allows.
///
/// @throws InvalidArgument if run.threads is negative, and what `work` throws
void enter_arena(const Run& run, const std::function<void()>& work);

/// Like `enter_arena`, and returns what `work()` returns.
template <class Work>
auto in_arena(const Run& run, const Work& work) {
  using Result = std::invoke_result_t<const Work&>;
  if constexpr (std::is_void_v<Result>) {
    enter_arena(run, std::cref(work));
  } else {
    std::optional<Result> result;
    enter_arena(run, [&] { result.emplace(work()); });
    return *std::move(result);
  }
}

/// Runs the body of a public function with the threads, progress function and time limit of `run`. Returns
/// what `work()` returns.
///
/// @throws InvalidArgument for negative threads, a negative or NaN time limit; Stopped; what `work` throws
template <class Work>
auto in_call(const Run& run, const Work& work) {
  const RunScope scope(run);
  return in_arena(run, work);
}

}  // namespace meshorder
