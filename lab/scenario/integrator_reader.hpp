// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenario/scenario.hpp"
#include "lab/support/json.hpp"

namespace meshorder {

inline constexpr NumberRange kPositive{.min = 0, .min_open = true};
inline constexpr NumberRange kNotNegative{.min = 0};

/// Reads `material`, `integrator`, `solver`, `contact`, `water` and `order.every` of a scenario's file; which
/// keys are allowed depends on the method. Throws Error like parse_scenario.
void read_integrator(const JsonValue& root, Scenario& scenario);

}  // namespace meshorder
