// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include <meshorder/payoff.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace meshorder::command {

/// Prints the line that gives the mesh the order of a candidate.
void print_line_for(const Console& console, const Candidate& candidate, bool is_matrix,
                    const std::string& mesh);

/// Prints the line that makes the order which the sentence on a mesh names; where nothing is gained, whether
/// `order` moves the mesh all the same.
void print_next(const Console& console, const Advice& advice, const std::string& mesh);

/// Prints what the mesh's order costs, kernel by kernel, and what others are worth.
void print_times(const Console& console, const Advice& advice);

/// Returns the keys that docs/json.md lists.
nlohmann::ordered_json to_json(const Advice& advice);

}  // namespace meshorder::command
