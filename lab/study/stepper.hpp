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

// The messages between a study and the processes that simulate for it, one JSON object a line. The process
// answers each question, or answers {"error": …} and ends.

/// What to simulate.
struct StepperTask {
  std::string scenario = {};         ///< a name or a file
  std::string mesh = {};             ///< a file, instead of the scenario's own
  std::string vertex_order = {};     ///< file of the NumPy array old_to_new; empty: the mesh's own order
  std::string cell_order = {};       ///< the same for cells
  std::vector<int> processors = {};  ///< to bind the process to; empty: not bound
  // of a fluid, which has no mesh and no files of orders
  std::string vertex_method = {};   ///< "auto": a Reorderer decides when to order; others: see FluidOrdering
  std::string element_method = {};  ///< in each step
  double spacing = 0;               ///< of its particles, m
};

/// Describes a body that is ready to be simulated.
struct StepperReady {
  Index vertices = 0;
  Offset tetrahedra = 0;
  double longest_side = 0;  ///< of the box around the body at rest, m
  double setup_seconds = 0;
  double step_seconds = 0;       ///< of the warm-up step, which is undone
  Offset bytes = 0;              ///< memory of the body
  std::string fingerprint;       ///< of the mesh, and of the parameters in this order
  bool fixed_addresses = false;  ///< address space randomisation is off
};

/// Asks for steps.
struct StepperTurn {
  Index steps = 0;
  std::string frames;         ///< file for the motion, in the mesh's own order; empty: no frames
  Index frame_every = 1;      ///< a frame at the start and after every so many steps
  bool last = false;          ///< completes the file of the frames
  std::string surfaces = {};  ///< file for the surface of a fluid in the frames; empty: none
};

/// Timings and iteration counts of the steps of a turn.
struct StepperTimes {
  std::vector<double> step_seconds;  ///< of each step, without writing frames
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

// These functions throw nlohmann::json::exception for a message of another kind.
StepperTask stepper_task(const nlohmann::json& message);
StepperReady stepper_ready(const nlohmann::json& message);
StepperTurn stepper_turn(const nlohmann::json& message);
StepperTimes stepper_times(const nlohmann::json& message);

/// Serves a study over a pair of streams: reads a StepperTask, sets up the body, runs a warm-up step and
/// undoes it; then simulates and times turn after turn until the input ends. An error is the last answer.
void serve_steps(std::istream& questions, std::ostream& answers);

/// A simulation in a new process. Where the system allows it, the memory of all such processes is at the same
/// addresses.
class Stepper {
 public:
  /// Starts `program`, which is meshorder, and waits until the body is ready. Throws Error with the process's
  /// message.
  Stepper(const std::filesystem::path& program, int threads, const StepperTask& task);

  [[nodiscard]] const StepperReady& ready() const noexcept { return ready_; }

  /// Runs the steps of a turn and waits for them. Throws Error with the process's message.
  StepperTimes take(const StepperTurn& turn);

 private:
  nlohmann::json ask(const nlohmann::json& question);

  std::string name_;
  ChildProcess process_;
  StepperReady ready_;
};

}  // namespace meshorder
