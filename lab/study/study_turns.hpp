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

/// How the steps of a scenario are shared out.
struct TurnPlan {
  Index steps = 0;
  Index frame_every = 1;
  Index turn = 1;           ///< steps, a multiple of frame_every
  bool interleaved = true;  ///< all orders at once, by turns
};

/// Turns of about a second, yet eight of them at least where the steps suffice; about 48 frames, fewer of
/// bodies with so many vertices that the file would have more than 256 MB; all orders at once where the
/// memory that is free holds them. `budget_seconds` as StudyPlan::scenario_seconds.
TurnPlan plan_turns(const StepperReady& body, Index steps, std::optional<double> budget_seconds, int orders);

/// One run of a scenario in all orders.
struct Round {
  std::filesystem::path program;
  int threads = 1;
  std::vector<StepperTask> tasks;    ///< one for each order
  std::vector<std::string> motions;  ///< a file for each order's frames; none: no frames
  TurnPlan plan;
  int number = 0;  ///< the order that begins is this one, modulo their number
};

/// Runs it; `after_turn` is told the share of the steps that are done and says whether to go on. None when it
/// does not. Throws Error when a process does, or when the first order's body is not that of `fingerprint`.
std::optional<std::vector<RunRecord>> run_round(const Round& round, const std::string& fingerprint,
                                                const std::function<bool(double share)>& after_turn);

}  // namespace meshorder
