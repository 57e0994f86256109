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

/// An order in which a program was run. The first order is the mesh's own.
struct TriedOrder {
  std::string name;             ///< "original", "rcm", "hilbert/hilbert"
  MeshMethods methods;          ///< for the options of `order`
  bool by_auto = false;         ///< `auto` chose it
  std::string made_by{};        ///< the command that makes it
  double order_seconds = 0;     ///< seconds of that command; for a mesh, reading and writing included
  std::vector<double> times{};  ///< of the runs that count
  double count = -1;            ///< number captured by --count; negative: none
  std::int64_t peak_bytes = 0;
  std::string fault{};        ///< why it was excluded from the trial; empty: it was not
  bool is_different = false;  ///< excluded because its results differ
};

/// Result of a trial.
struct TrialReport {
  std::vector<std::string> command;
  std::string call;  ///< the command line that repeats the trial
  std::string time;  ///< "cpu", "wall" or a regular expression
  std::vector<TriedOrder> orders;
  PairedTrials trials{0};
  std::vector<std::string> left_out;  ///< names of orders for which there was no time
  double budget_seconds = 0;
  double run_seconds = 0;  ///< wall-clock time of all runs
};

/// Returns the time of an order that was run: for the mesh's own order the median; for another order this
/// median divided by the order's speedup. Speedups compare runs of the same round, so rounds in which the
/// machine was slower do not distort them.
double time_of(const TrialReport& report, std::size_t order);

/// Returns the time of an order in words: "2.7 s", or a number that the program prints.
std::string time_in_words(const TrialReport& report, std::size_t order);

/// Prints the sentence and a table of the orders.
void print_trial(const Console& console, const TrialReport& report);

nlohmann::ordered_json to_json(const TrialReport& report);

/// Returns a page for the browser that needs no other files: the sentence, a bar with its interval for each
/// order, and the commands.
std::string trial_page(const TrialReport& report);

/// Returns whether times are in seconds, as opposed to a number that the program prints.
bool is_in_seconds(const TrialReport& report);

/// Returns whether the best order is faster than the mesh's own.
bool is_faster(const TrialReport& report);

/// Returns "faster", "slower", "tie", "not told apart", or "undecided" if there are too few runs to say or if
/// they decide nothing yet.
std::string verdict_name(const TrialReport& report);

/// Returns the name of a program for messages; for python, bash and other interpreters, the script's name.
std::string program_name(const std::vector<std::string>& command);

/// Returns what is known of the best order so far: "rcm 1.08–1.16"; "" if nothing is.
std::string known_so_far(const TrialReport& report);

/// Returns "1.08–1.16", or "" if too few pairs were run.
std::string interval_in_words(const TimeRatio& speedup);

/// Returns the number of runs after which the best order has saved its cost; nothing if it saves no seconds.
std::optional<double> runs_to_pay(const TrialReport& report);

/// Returns how many orders besides the mesh's own can be compared in `runs` runs; at least 1.
std::size_t orders_that_fit(double runs);

/// Returns the budget, in seconds, that an undecided trial needs to get an interval or, if it has one, to
/// halve the interval's width. Returns nothing for other trials.
std::optional<double> needed_budget(const TrialReport& report);

/// Returns the result of the trial in one sentence, which contains the verdict.
std::string trial_in_words(const TrialReport& report);

}  // namespace meshorder::command
