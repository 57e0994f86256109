// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/stepper_messages.hpp"
#include "lab/support/child_process.hpp"

#include <filesystem>
#include <istream>
#include <ostream>

namespace meshorder {

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
