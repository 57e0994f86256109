// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include <meshorder/payoff.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace meshorder::command {

/// Returns [low, high]; null if the ratio has no interval.
nlohmann::ordered_json interval_json(const TimeRatio& ratio);

/// Prints the command that makes the order of a candidate.
void print_line_for(const Console& console, const Candidate& candidate, bool is_matrix,
                    const std::string& mesh);

/// Prints the command for the order that the verdict names. If no gain is known but `order` would move the
/// mesh, prints the command for its order.
void print_next(const Console& console, const Advice& advice, const std::string& mesh);

/// Prints the times of the kernels in the present order, and the speedups and commands of other orders.
void print_times(const Console& console, const Advice& advice);

/// Returns the keys that docs/json.md lists.
nlohmann::ordered_json to_json(const Advice& advice);

/// Returns the grade of the present order, and the mean spans that it rests on.
nlohmann::ordered_json grade_json(const Advice& advice, Index vertices);

}  // namespace meshorder::command
