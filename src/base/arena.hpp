// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/run_scope.hpp"
#include <meshorder/options.hpp>

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

namespace meshorder {

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
/// @throws InvalidArgument for a negative number of threads or time limit, Stopped, and what `work` throws
template <class Work>
auto in_call(const Run& run, const Work& work) {
  const RunScope scope(run);
  return in_arena(run, work);
}

}  // namespace meshorder
