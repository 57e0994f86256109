// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "program_output.hpp"
#include "trial.hpp"
#include "trial_folder.hpp"
#include "try_report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

/// Returns a word of the command line with the mesh in place of {}, its name without extension in place of
/// {stem}, and the path for outputs in place of {out}.
std::string with_places(const std::string& word, const TrialSubject& subject, const TrialFolder& folder);

/// Reads the times, counts and results of a program from its printed output and its files.
class TrialReadings {
 public:
  /// Throws InvalidArgument for faulty expressions, and for a file that is not in the program's folder.
  TrialReadings(const TrialOptions& options, const TrialSubject& subject, const TrialFolder& folder);

  /// Reads the results of a run. Throws InvalidArgument if a requested result is missing. Returns how the
  /// results differ from those of the first run; empty if they are the same.
  std::string read(TriedOrder& order, double& time);

 private:
  const TrialFolder& folder_;
  double tolerance_;
  std::string same_file_;
  std::optional<PrintedNumbers> time_;
  std::optional<PrintedNumbers> count_;
  std::optional<PrintedNumbers> same_;
  std::optional<std::vector<double>> numbers_;  ///< of the first run
  std::optional<std::string> text_;             ///< of the first run
};

}  // namespace meshorder::command
