// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/scenario.hpp"
#include "lab/support/json.hpp"

namespace meshorder {

inline constexpr NumberRange kPositive{.min = 0, .min_open = true};
inline constexpr NumberRange kNotNegative{.min = 0};

/// Reads `material`, `integrator`, `solver` and `contact` of a scenario's file; their keys depend on the
/// method. Throws Error like parse_scenario.
void read_integrator(const JsonValue& root, Scenario& scenario);

}  // namespace meshorder
