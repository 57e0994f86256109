// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"
#include <meshorder/error.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/options.hpp>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace meshorder {

/// Calls `work()` in a TBB arena of its own with as many threads as `run` allows, and returns its result.
///
/// @throws InvalidArgument if run.threads is negative
template <class Work>
decltype(auto) in_arena(const Run& run, Work&& work) {
  if (run.threads < 0) throw InvalidArgument("run: threads must not be negative");
  // TBB warns on stderr of a wish for more threads than it may start, and sets aside memory for all of them
  const std::size_t limit = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const int wanted = run.threads > 0 ? run.threads : tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(std::cmp_less(wanted, limit) ? wanted : static_cast<int>(limit));
  return arena.execute(std::forward<Work>(work));
}

/// Calls `work(begin, end)` for the ranges of `size` that make up 0 … n−1, on all threads of the arena. The
/// ranges do not depend on the number of threads. As for_each_chunk, for more than 2³¹ entries.
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
