// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace meshorder {

/// What an order saves in one of the paper's scenarios, over vertices scrambled: 240 steps on a Xeon E5-1620
/// v4.
struct PaperSaving {
  std::string_view ordering;  ///< StudyOrdering::name
  double seconds = 0;
  double percent = 0;  ///< of the scrambled order's time
};

/// What the paper tells of a scenario in words: the caption of its figure. The figures of its Tables 1 to 4
/// are not in the text that this project has; nothing is known of VF scrambled.
struct PaperScenario {
  std::string_view name;
  std::string_view mesh;
  std::string_view figure;  ///< "Figure 4"
  std::array<PaperSaving, 3> savings;
};

/// Time steps of each of its runs.
inline constexpr Index kPaperSteps = 240;

std::span<const PaperScenario> paper_scenarios();

/// nullptr for a scenario that is not the paper's.
const PaperScenario* find_paper_scenario(std::string_view name);

/// Nothing where the paper tells nothing of the scenario or of that order in it.
std::optional<PaperSaving> paper_saving(std::string_view scenario, std::string_view ordering);

/// Seconds of the scenario's steps in an order, *derived*: the scrambled order's are all seconds saved over
/// all per cents, good to half a per cent since those are rounded; another's are less by what it saves.
std::optional<double> paper_seconds(std::string_view scenario, std::string_view ordering);

}  // namespace meshorder
