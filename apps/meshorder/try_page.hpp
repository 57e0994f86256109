// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "try_report.hpp"

#include <string>

namespace meshorder::command {

/// Returns a page for the browser that needs no other files: the sentence, a bar with its interval for each
/// order, and the commands. `input` is the mesh or case as the user named it.
std::string trial_page(const TrialReport& report, const std::string& input);

}  // namespace meshorder::command
