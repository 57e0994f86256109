// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "lab/scenario/motion_file.hpp"
#include "lab/scenario/simulation.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace meshorder::command {

/// Prints the scenario, mesh, order, material and method.
void print_header(const Console& console, const Simulation& simulation, const std::string& mesh);

/// Prints times, iterations and the change of energy and momentum.
void print_summary(Console& console, const Simulation& simulation, const MotionRecord& record);

/// Returns the object of docs/json.md without its keys about reading, frames and checkpoints.
nlohmann::ordered_json to_json(const Simulation& simulation, const MotionRecord& record);

}  // namespace meshorder::command
