// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/paper.hpp"

#include "lab/study/results.hpp"

namespace meshorder {
namespace {

constexpr std::array kScenarios{
    PaperScenario{"falling",
                  "dragon",
                  "Figure 4",
                  {{{"original", 272.9, 14.8}, {"fiedler", 492.4, 26.7}, {"vf-fiedler", 514, 27.8}}}},
    PaperScenario{"constrained",
                  "dragon",
                  "Figure 5",
                  {{{"original", 266.5, 12.1}, {"fiedler", 469.8, 21.3}, {"vf-fiedler", 494.7, 22.4}}}},
    PaperScenario{"stretch",
                  "dragon",
                  "Figure 6",
                  {{{"original", 19.8, 4.66}, {"fiedler", 51.7, 12.1}, {"vf-fiedler", 108.2, 25.5}}}},
    PaperScenario{"unsquash",
                  "armadillo",
                  "Figure 7",
                  {{{"original", 84.4, 3.63}, {"fiedler", 236.8, 10.2}, {"vf-fiedler", 273.5, 11.8}}}},
    PaperScenario{"bowl",
                  "armadillo",
                  "Figure 8",
                  {{{"original", 177.6, 4.1}, {"fiedler", 480.7, 11.1}, {"vf-fiedler", 451.5, 10.4}}}},
    PaperScenario{"bounce",
                  "bunny",
                  "Figure 9",
                  {{{"original", 262.8, 8.23}, {"fiedler", 426.2, 13.3}, {"vf-fiedler", 449.2, 14.1}}}}};

}  // namespace

std::span<const PaperScenario> paper_scenarios() { return kScenarios; }

const PaperScenario* find_paper_scenario(std::string_view name) { return find_named(kScenarios, name); }

std::optional<PaperSaving> paper_saving(std::string_view scenario, std::string_view ordering) {
  const PaperScenario* const found = find_paper_scenario(scenario);
  if (found == nullptr) return std::nullopt;
  for (const PaperSaving& saving : found->savings) {
    if (saving.ordering == ordering) return saving;
  }
  return std::nullopt;
}

std::optional<double> paper_seconds(std::string_view scenario, std::string_view ordering) {
  const PaperScenario* const found = find_paper_scenario(scenario);
  if (found == nullptr) return std::nullopt;
  double seconds = 0;
  double percent = 0;
  for (const PaperSaving& saving : found->savings) {
    seconds += saving.seconds;
    percent += saving.percent;
  }
  const double scrambled = seconds / (percent / 100);
  if (ordering == "scrambled") return scrambled;
  const std::optional<PaperSaving> saving = paper_saving(scenario, ordering);
  if (!saving) return std::nullopt;
  return scrambled - saving->seconds;
}

}  // namespace meshorder
