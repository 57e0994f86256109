// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace meshorder {

/// Time that an order saves in one of the paper's scenarios over scrambled vertices: 240 steps on a Xeon
/// E5-1620 v4.
struct PaperSaving {
  std::string_view ordering;  ///< OrderingSpec::name
  double seconds = 0;
  double percent = 0;  ///< of the scrambled order's time
};

/// Numbers in the caption of a scenario's figure. The numbers of the paper's Tables 1 to 4 are not in the
/// text that this project has. The captions give no numbers for VF scrambled.
struct PaperScenario {
  std::string_view name;
  std::string_view mesh;
  std::string_view figure;  ///< "Figure 4"
  std::array<PaperSaving, 3> savings;
};

/// Number of time steps in each of the paper's runs.
inline constexpr Index kPaperSteps = 240;

std::span<const PaperScenario> paper_scenarios();

/// Returns a scenario of the paper; nullptr if no scenario has that name.
const PaperScenario* find_paper_scenario(std::string_view name);

/// Returns what an order saves in a scenario, if the paper gives it.
std::optional<PaperSaving> paper_saving(std::string_view scenario, std::string_view ordering);

/// Returns the *derived* seconds of the scenario's steps in an order. For the scrambled order, these are the
/// sum of the seconds saved divided by the sum of the shares saved. This quotient is accurate to half a per
/// cent, since the percentages are rounded. For another order, the seconds that it saves are subtracted.
/// Empty if the paper gives no number.
std::optional<double> paper_seconds(std::string_view scenario, std::string_view ordering);

}  // namespace meshorder
