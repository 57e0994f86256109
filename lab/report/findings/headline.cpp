// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/headline.hpp"

#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/paper.hpp"
#include "lab/study/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace meshorder {
namespace {

/// From the least to the most of what is added.
struct Range {
  double least = std::numeric_limits<double>::max();
  double most = std::numeric_limits<double>::lowest();
  std::string least_name, most_name;

  [[nodiscard]] bool empty() const { return most < least; }

  void add(double value, const std::string& name) {
    if (value < least) {
      least = value;
      least_name = name;
    }
    if (value > most) {
      most = value;
      most_name = name;
    }
  }
};

/// An order's effect in the paper's scenarios, here and in the paper.
struct Effect {
  Range here, paper;
};

Effect effect_of(const StudyResults& results, const std::string& ordering) {
  Effect effect;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const OrderOfScenario* const order = find_order(scenario, ordering);
    const auto saving = paper_saving(scenario.name, ordering);
    if (order == nullptr || !saving || find_order(scenario, results.reference) == nullptr) continue;
    effect.here.add(order->speedup.percent, scenario.name);
    effect.paper.add(saving->percent, scenario.name);
  }
  return effect;
}

std::string percents(const Range& range) {
  return range.least == range.most ? fmt::format("{:.1f} %", range.most)
                                   : fmt::format("{:.1f} to {:.1f} %", range.least, range.most);
}

}  // namespace

std::string headline(const StudyResults& results) {
  if (results.reference != "scrambled") return {};
  const Effect vertices = effect_of(results, "fiedler");
  const Effect both = effect_of(results, "vf-fiedler");
  if (vertices.here.empty() && both.here.empty()) return {};
  std::string here = "Vertices along the Fiedler vector save " + percents(vertices.here);
  std::string paper = percents(vertices.paper);
  if (vertices.here.empty()) {
    here = "Vertices and elements along their Fiedler vectors save " + percents(both.here);
    paper = percents(both.paper);
  } else if (!both.here.empty()) {
    here += ", and elements along theirs as well " + percents(both.here) + ",";
    paper += " and " + percents(both.paper);
  }
  return fmt::format(
      "{} of the time that the same simulations take with vertices scrambled. The paper, with other "
      "simulators on a Xeon with 10 MB of cache, reports {}.",
      here, paper);
}

std::string against_all_scrambled(const StudyResults& results) {
  Range saved;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const OrderOfScenario* const ordered = find_order(scenario, "vf-fiedler");
    const OrderOfScenario* const scrambled = find_order(scenario, "vf-scrambled");
    if (ordered == nullptr || scrambled == nullptr || ordered->runs.size() != scrambled->runs.size())
      continue;
    const Speedup speedup = speedup_of(ordered->runs, scrambled->runs, scenario.turn, 0);
    if (speedup.beyond_noise) saved.add(speedup.percent, scenario.name);
  }
  if (saved.empty()) return {};
  const std::string range = saved.least == saved.most
                                ? fmt::format("{:.1f} % ({})", saved.most, saved.most_name)
                                : fmt::format("{:.1f} % ({}) to {:.1f} % ({})", saved.least, saved.least_name,
                                              saved.most, saved.most_name);
  return "Where elements are scrambled too, which the paper does not take for its reference, there is more "
         "to gain: "
         "VF Fiedler saves " +
         range + " of the time of VF scrambled.";
}

}  // namespace meshorder
