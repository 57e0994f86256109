// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/cholesky/supernodes.hpp"

#include <vector>

namespace meshorder {

/// A tree of tasks over a forest of supernodes: a task can start once those below it are done, and those are
/// independent of each other. Task 0 is the root; a task's number is greater than its parent's.
struct SolveTasks {
  std::vector<Index> parent;                   ///< −1 for task 0
  std::vector<std::vector<Index>> children;    ///< rising
  std::vector<std::vector<Index>> supernodes;  ///< of each task, rising: those below others come first
  std::vector<double> cost;                    ///< of a task and all below it

  [[nodiscard]] Index count() const noexcept { return static_cast<Index>(parent.size()); }
};

/// Cuts the forest wherever two branches or more are worth a task: each costs at least `least`; small
/// branches are bundled. Does not depend on the number of threads. O(supernodes).
SolveTasks make_solve_tasks(const Supernodes& supernodes, double least);

}  // namespace meshorder
