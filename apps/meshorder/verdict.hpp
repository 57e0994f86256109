// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include "payoff/advice.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace meshorder::command {

/// What the order that a mesh has costs, kernel by kernel, and what another is worth: the end of `info`.
void print_verdict(const Console& console, const Advice& advice);

/// The verdict in a sentence: which kernel loses most, what orders the mesh better, and when that has paid
/// for itself; or that there is nothing to gain.
std::string verdict_sentence(const Advice& advice);

/// See docs/json.md.
nlohmann::ordered_json to_json(const Advice& advice);

}  // namespace meshorder::command
