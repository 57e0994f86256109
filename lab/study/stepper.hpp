// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "lab/motion/integrator.hpp"
#include "lab/support/process.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

namespace meshorder {

// What a study and the processes that step for it say to each other: one JSON object a line. The study asks,
// the process answers each question by what it asked for, or by {"error": …} and ends.

/// What to simulate.
struct StepperTask {
  std::string scenario;      ///< a name or a file
  std::string mesh;          ///< a file, in the place of the scenario's
  std::string vertex_order;  ///< a NumPy array, old_to_new, for the mesh and its cells; none: as they are
  std::string cell_order;
  std::vector<int> processors;  ///< to be bound to; empty: not bound
};

/// A body that is ready to be stepped.
struct StepperReady {
  Index vertices = 0;
  Offset tetrahedra = 0;
  double longest_side = 0;  ///< of the box around the body at rest, m
  double setup_seconds = 0;
  double step_seconds = 0;       ///< of the first step, which is then taken back
  Offset bytes = 0;              ///< that the body holds
  std::string fingerprint;       ///< of the mesh, and of the parameters in this order
  bool fixed_addresses = false;  ///< the system puts arrays where it puts them in every such process
};

/// Steps to be taken, one after another.
struct StepperTurn {
  Index steps = 0;
  std::string frames;     ///< a file for the motion, in the mesh's own order; empty: none is kept
  Index frame_every = 1;  ///< a frame after each step that this divides, and at the start
  bool last = false;      ///< the file of the frames is then complete
};

/// What they took.
struct StepperTimes {
  std::vector<double> step_seconds;  ///< of each step call, without the frames
  StepReport::Seconds seconds;       ///< sums
  Offset cg_iterations = 0;
  Offset admm_iterations = 0;
  Offset contact_iterations = 0;
  std::vector<std::string> warnings;
};

nlohmann::json to_json(const StepperTask& task);
nlohmann::json to_json(const StepperReady& ready);
nlohmann::json to_json(const StepperTurn& turn);
nlohmann::json to_json(const StepperTimes& times);

// Throw nlohmann::json::exception for what is no such message.
StepperTask stepper_task(const nlohmann::json& message);
StepperReady stepper_ready(const nlohmann::json& message);
StepperTurn stepper_turn(const nlohmann::json& message);
StepperTimes stepper_times(const nlohmann::json& message);

/// Answers a study's questions: a StepperTask first, then turn after turn until the input ends. Sets the body
/// up, takes one step to warm up memory and processor and takes it back, and from then on times step calls
/// and nothing else. Whatever goes wrong is the last answer.
void serve_steps(std::istream& questions, std::ostream& answers);

/// A simulation in a process of its own, so that all orders find memory as it is in a fresh process: at the
/// same addresses, where the system allows it.
class Stepper {
 public:
  /// `program` is meshorder. Waits until the body is ready. Throws Error with what the process says is wrong.
  Stepper(const std::filesystem::path& program, int threads, const StepperTask& task);

  [[nodiscard]] const StepperReady& ready() const noexcept { return ready_; }

  /// Takes the steps of a turn and waits for them. Throws Error with what the process says is wrong.
  StepperTimes take(const StepperTurn& turn);

 private:
  nlohmann::json ask(const nlohmann::json& question);

  std::string name_;
  ChildProcess process_;
  StepperReady ready_;
};

}  // namespace meshorder
