// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/study_turns.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <numeric>

namespace meshorder {
namespace {

constexpr Index kFrames = 48;
constexpr Offset kMotionBytes = Offset{256} << 20;
constexpr double kTurnSeconds = 1.0;
constexpr Index kMinTurns = 8;
constexpr Index kMinSteps = 8;
/// Memory of a process relative to its body: the process also holds the mesh and what the body was made from.
constexpr double kProcessBytesOfBody = 2.5;

/// Returns the bytes available to new processes; unlimited if the system does not report them.
double available_bytes() {
  std::ifstream in("/proc/meminfo");
  for (std::string key, unit; in >> key;) {
    double kilobytes = 0;
    if (!(in >> kilobytes)) break;
    std::getline(in, unit);
    if (key == "MemAvailable:") return 1024 * kilobytes;
  }
  return std::numeric_limits<double>::max();
}

void add(const RunRecord& turn, RunRecord& run) {
  run.step_seconds.insert(run.step_seconds.end(), turn.step_seconds.begin(), turn.step_seconds.end());
  run.seconds += turn.seconds;
  run.cg_iterations += turn.cg_iterations;
  run.admm_iterations += turn.admm_iterations;
  run.contact_iterations += turn.contact_iterations;
  run.other_seconds += turn.other_seconds;
  run.pace_seconds.insert(run.pace_seconds.end(), turn.pace_seconds.begin(), turn.pace_seconds.end());
  run.warnings.insert(run.warnings.end(), turn.warnings.begin(), turn.warnings.end());
}

/// Returns groups of orders; the orders of a group are in memory together.
std::vector<std::vector<std::size_t>> groups_of(const Round& round) {
  std::vector<std::size_t> all(round.tasks.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::rotate(all.begin(), all.begin() + round.number % index_size(all), all.end());
  if (round.plan.interleaved) return {all};
  std::vector<std::vector<std::size_t>> groups;
  groups.reserve(all.size());
  for (const std::size_t order : all) groups.push_back({order});
  return groups;
}

}  // namespace

TurnPlan plan_turns(const StepperReady& body, Index steps, std::optional<double> budget_seconds, int orders) {
  TurnPlan plan;
  const double step_seconds = std::max(body.step_seconds, 1e-6);
  plan.steps = steps;
  if (budget_seconds)
    plan.steps = static_cast<Index>(
        std::clamp<double>(*budget_seconds / (orders * step_seconds), std::min(kMinSteps, steps), steps));
  const Offset frame_bytes = Offset{12} * std::max<Index>(1, body.vertices);
  const Offset frames = std::clamp<Offset>(kMotionBytes / frame_bytes, 1, kFrames);
  plan.frame_every = static_cast<Index>((plan.steps + frames - 1) / frames);
  const double wanted = std::ceil(kTurnSeconds / (step_seconds * plan.frame_every));
  const Index most = std::max<Index>(1, plan.steps / (kMinTurns * plan.frame_every));
  plan.turn = plan.frame_every * static_cast<Index>(std::clamp<double>(wanted, 1, most));
  plan.interleaved = orders * kProcessBytesOfBody * static_cast<double>(body.bytes) < available_bytes();
  return plan;
}

std::optional<std::vector<RunRecord>> run_round(const Round& round, const std::string& fingerprint,
                                                const std::function<bool(double share)>& after_turn) {
  std::vector<RunRecord> runs(round.tasks.size());
  const double all_steps = static_cast<double>(round.plan.steps) * static_cast<double>(runs.size());
  double steps_done = 0;
  for (const std::vector<std::size_t>& group : groups_of(round)) {
    std::vector<std::unique_ptr<Stepper>> steppers(runs.size());
    for (const std::size_t order : group) {
      steppers[order] = std::make_unique<Stepper>(round.program, round.threads, round.tasks[order]);
      const StepperReady& ready = steppers[order]->ready();
      if (order == 0 && ready.fingerprint != fingerprint)
        throw InputError(round.tasks[order].scenario,
                         "differs from the one that the study in this folder began with",
                         "give a new folder, or the scenario and mesh as they were");
      runs[order].began = timestamp_now();
      runs[order].setup_seconds = ready.setup_seconds;
      runs[order].bytes = ready.bytes;
      if (!after_turn(steps_done / all_steps)) return std::nullopt;
    }
    std::size_t first = 0;
    for (Index done = 0; done < round.plan.steps; done += round.plan.turn, ++first) {
      StepperTurn turn;
      turn.steps = std::min(round.plan.turn, round.plan.steps - done);
      turn.frame_every = round.plan.frame_every;
      turn.last = done + turn.steps == round.plan.steps;
      for (std::size_t i = 0; i < group.size(); ++i) {
        const std::size_t order = group[(first + i) % group.size()];
        if (!round.motions.empty()) turn.frames = round.motions[order];
        turn.surfaces = order == 0 ? round.surfaces : "";
        add(steppers[order]->take(turn), runs[order]);
        steps_done += turn.steps;
        if (!after_turn(steps_done / all_steps)) return std::nullopt;
      }
    }
  }
  return runs;
}

}  // namespace meshorder
