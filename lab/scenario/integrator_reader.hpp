// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/scenario.hpp"
#include "lab/support/json.hpp"

namespace meshorder {

inline constexpr NumberRange kPositive{.least = 0, .least_open = true};
inline constexpr NumberRange kNotNegative{.least = 0};

/// Reads `material`, `integrator`, `solver` and `contact` of a scenario's file, whose keys depend on the
/// method. Throws Error as parse_scenario does.
void read_integrator(const JsonValue& root, Scenario& scenario);

}  // namespace meshorder
