// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "try_report.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

/// Returns whether times are in seconds, as opposed to a number that the program prints.
bool is_in_seconds(const TrialReport& report);

/// Returns whether the best order is faster than the mesh's own.
bool is_faster(const TrialReport& report);

/// Returns "faster", "slower", "tie" or "undecided".
std::string verdict_name(const TrialReport& report);

/// Returns the name of a program for messages; for python, bash and other interpreters, that of the script.
std::string program_name(const std::vector<std::string>& command);

/// Returns "1.12", near 1 "1.003".
std::string ratio_in_words(double ratio);

/// Returns "1.08–1.16", or "" if too few pairs were run.
std::string interval_in_words(const TimeRatio& speedup);

/// Returns the number of runs after which the best order has saved its cost; nothing if it saves no seconds.
std::optional<double> runs_to_pay(const TrialReport& report);

/// Returns the number of orders, without the mesh's own, that can be compared in this many runs; at least 1.
std::size_t orders_that_fit(double runs);

/// Returns the budget, in seconds, that an undecided trial needs to get an interval or, if it has one, to
/// halve the interval's width. Returns nothing for other trials.
std::optional<double> needed_budget(const TrialReport& report);

/// Returns the result of the trial in one sentence, which contains the verdict.
std::string trial_in_words(const TrialReport& report);

}  // namespace meshorder::command
