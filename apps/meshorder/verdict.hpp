// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "payoff/advice.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace meshorder::command {

/// Prints what the mesh's order costs, kernel by kernel, and what another is worth: the end of `info`.
void print_verdict(const Console& console, const Advice& advice);

/// Returns the verdict as a sentence: which kernel loses most, the command that orders the mesh better and
/// when it pays for itself; or that there is nothing to gain.
std::string verdict_sentence(const Advice& advice);

/// Returns the keys that docs/json.md lists.
nlohmann::ordered_json to_json(const Advice& advice);

}  // namespace meshorder::command
