// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace meshorder {
namespace {

/// Returns how many threads TBB may start. If asked for more threads, TBB warns on stderr and reserves memory
/// for all of them.
std::size_t allowed_threads() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

}  // namespace

Index thread_count() {
  return std::min(static_cast<Index>(allowed_threads()), Index{tbb::this_task_arena::max_concurrency()});
}

void share_turns(Offset n, Sharing sharing, const std::function<void(Offset, Offset)>& work) {
  const tbb::blocked_range<Offset> turns(0, n);
  const auto do_some = [&](const tbb::blocked_range<Offset>& some) { work(some.begin(), some.end()); };
  tbb::task_group_context context;
  if (sharing == Sharing::repeated) {
    tbb::parallel_for(turns, do_some, tbb::static_partitioner(), context);
  } else {
    tbb::parallel_for(turns, do_some, context);
  }
  if (context.is_group_execution_cancelled()) throw Stopped();
}

void enter_arena(const Run& run, const std::function<void()>& work) {
  if (run.threads < 0) throw InvalidArgument("run: threads must not be negative");
  const std::size_t limit = allowed_threads();
  const int wanted = run.threads > 0 ? run.threads : tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(std::cmp_less(wanted, limit) ? wanted : static_cast<int>(limit));
  arena.execute(work);
}

}  // namespace meshorder
