// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/folder.hpp"
#include "lab/study/stepper.hpp"
#include "lab/study/study_plan.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace meshorder {

/// The division of a scenario's steps into turns.
struct TurnPlan {
  Index steps = 0;
  Index frame_every = 1;
  Index turn = 1;           ///< steps of a turn, a multiple of frame_every
  bool interleaved = true;  ///< all orders are in memory and take turns
};

/// Returns a plan with:
/// - turns of about a second, but at least eight turns if there are enough steps;
/// - about 48 frames, fewer if their file would exceed 256 MB;
/// - all orders at once if free memory holds them.
///
/// `budget_seconds` is StudyPlan::scenario_seconds.
TurnPlan plan_turns(const StepperReady& body, Index steps, std::optional<double> budget_seconds, int orders);

/// One run of a scenario in all orders.
struct Round {
  std::filesystem::path program;
  int threads = 1;
  std::vector<StepperTask> tasks;    ///< one for each order
  std::vector<std::string> motions;  ///< a file for each order's frames; empty: no frames
  std::string surfaces;              ///< a file for the surface of a fluid in the first order; empty: none
  TurnPlan plan;
  int number = 0;  ///< index of the run, which begins with order `number` modulo the number of orders
};

/// Runs a round. Calls `after_turn` after each set-up and turn, with the share of steps done; if `after_turn`
/// returns false, stops and returns nothing. Throws Error if a process fails, or if the first order's body
/// does not have the fingerprint `fingerprint`.
std::optional<std::vector<RunRecord>> run_round(const Round& round, const std::string& fingerprint,
                                                const std::function<bool(double share)>& after_turn);

}  // namespace meshorder
