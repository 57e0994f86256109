// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "console.hpp"
#include <meshorder/payoff.hpp>

#include <nlohmann/json_fwd.hpp>

namespace meshorder::command {

/// Prints what the mesh's order costs, kernel by kernel, and what another is worth: the end of `info`.
void print_verdict(const Console& console, const Advice& advice);

/// Returns the keys that docs/json.md lists.
nlohmann::ordered_json to_json(const Advice& advice);

}  // namespace meshorder::command
