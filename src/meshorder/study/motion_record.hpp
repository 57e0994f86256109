// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/base/index.hpp>
#include <meshorder/sim/implicit/backward_euler.hpp>

#include <string>
#include <vector>

namespace meshorder {

/// What a step took.
struct StepRecord {
  Index newton_iterations = 0;
  Index cg_iterations = 0;
  double residual = 0;                          ///< of the last linear solve
  double seconds = 0, assembly = 0, solve = 0;  ///< the step, and parts of it
};

/// A warning that steps gave, however its numbers differed.
struct WarningRecord {
  std::string first;     ///< its words at the first time
  Index first_step = 0;  ///< counted from 1
  Index count = 0;
};

/// What happened in a simulation so far.
struct MotionRecord {
  std::vector<StepRecord> steps;
  std::vector<Balance> balances;  ///< at the start and after each step
  std::vector<WarningRecord> warnings;
};

/// Adds a step and the balance after it.
void add(const StepReport& report, const Balance& balance, MotionRecord& record);

}  // namespace meshorder
