// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "lab/scenario/motion_file.hpp"
#include "lab/scenario/simulation.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace meshorder::command {

/// What is simulated, before it is.
void print_header(const Console& console, const Simulation& simulation, const std::string& mesh);

/// What it took, and what is conserved.
void print_summary(const Console& console, const Simulation& simulation, const MotionRecord& record);

/// Keys as docs/json.md lists them, but for what only the run knows.
nlohmann::ordered_json to_json(const Simulation& simulation, const MotionRecord& record);

}  // namespace meshorder::command
