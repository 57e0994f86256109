// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/arena.hpp"
#include "base/run_scope.hpp"

#include <utility>

namespace meshorder {

/// Does the work of a public function as `run` wants it: in an arena of its own, with progress and time
/// limit. Returns what `work()` returns.
///
/// @throws InvalidArgument for a negative number of threads or time limit, Stopped, and what `work` throws
template <class Work>
decltype(auto) in_call(const Run& run, Work&& work) {
  const RunScope scope(run);
  return in_arena(run, std::forward<Work>(work));
}

}  // namespace meshorder
