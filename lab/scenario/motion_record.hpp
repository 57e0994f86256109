// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "lab/motion/integrator.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// What a step took, and where it left the body. Its warnings are in MotionRecord::warnings.
struct StepRecord {
  StepReport report;
  double shape_distance = 0;  ///< see distance_from_shape, m
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

/// Adds a warning of a step, unless one was there that differs in numbers alone, which then counts once more.
/// Returns whether it is new.
bool add_warning(const std::string& warning, Index step, std::vector<WarningRecord>& warnings);

/// Adds a step and what is true after it.
void add(StepReport report, double shape_distance, const Balance& balance, MotionRecord& record);

}  // namespace meshorder
