// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include "console.hpp"
#include "payoff/paired_trials.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

/// An order in which a program was run. The first one is the mesh's own.
struct TriedOrder {
  std::string name;             ///< "original", "rcm", "hilbert/hilbert"
  OrderNames methods;           ///< as `order` takes them
  bool by_auto = false;         ///< `auto` takes it
  std::string made_by{};        ///< the command that makes it
  double order_seconds = 0;     ///< what that took, without reading and writing
  std::vector<double> times{};  ///< of the runs that count
  double count = -1;            ///< that --count captured, negative: none
  std::int64_t peak_bytes = 0;
  std::string fault{};        ///< why it is out of the trial; empty: it is not
  bool is_different = false;  ///< it is, as its results differ
};

/// What a trial found.
struct TrialReport {
  std::vector<std::string> command;
  std::string time;  ///< "cpu", "wall" or a regular expression
  std::vector<TriedOrder> orders;
  PairedTrials trials{0};
  std::vector<std::string> left_out;  ///< orders that there was no time for
  double run_seconds = 0;             ///< of all runs, by the clock
};

/// Returns whether times are in seconds, not in a number that the program prints.
bool is_in_seconds(const TrialReport& report);

/// Returns whether the best order is faster than the mesh's own.
bool is_faster(const TrialReport& report);

/// Returns the sentence that says what the trial found.
std::string trial_in_words(const TrialReport& report);

/// Prints the sentence and a table of the orders.
void print_trial(const Console& console, const TrialReport& report);

nlohmann::ordered_json to_json(const TrialReport& report);

}  // namespace meshorder::command
