// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "progress.hpp"
#include "trial_subject.hpp"
#include "try_report.hpp"

#include <string>
#include <vector>

namespace meshorder::command {

/// The program to run, and how its runs are judged; see docs/try.md.
struct TrialOptions {
  std::vector<std::string> command;
  std::string call;                  ///< the command line that repeats the trial
  std::vector<std::string> methods;  ///< empty: TrialSubject::orders
  std::vector<std::string> with;     ///< files beside the mesh; empty: all
  std::string time = "cpu";
  std::string count;
  std::string same;
  std::string same_file;
  std::string keep;
  double tolerance = 1e-6;
  double budget_seconds = 120;
  double timeout_seconds = 600;
  bool is_unprotected = false;  ///< the program may write to the originals by their full paths
};

/// Runs a program in several orders. Throws InvalidArgument for faulty options, and if the subject's own
/// order or all others fail; CommandError if `auto` or a named order cannot be made; Interrupted at a signal.
TrialReport run_trial(const TrialSubject& subject, const TrialOptions& options, Progress& progress,
                      Notes& notes);

}  // namespace meshorder::command
