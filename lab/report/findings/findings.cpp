// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/findings.hpp"

#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/mesh_findings.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/findings/paper.hpp"
#include "lab/report/tables/tables.hpp"
#include "lab/study/statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

/// The range of the values added, with the names of the ends.
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

/// Percentages that an order saves in the paper's scenarios, here and in the paper.
struct Effect {
  Range here, paper;
};

Effect paper_effect(const StudyResults& results, const std::string& ordering) {
  Effect effect;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const ScenarioOrderRecord* const order = find_order(scenario, ordering);
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

/// A scenario and the speedup of an order in it.
struct Compared {
  const ScenarioRecord* scenario;
  const Speedup* speedup;
};

/// Returns the scenarios in which an order and the reference have run.
std::vector<Compared> compared(const StudyResults& results, const std::string& ordering) {
  std::vector<Compared> list;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const ScenarioOrderRecord* const order = find_order(scenario, ordering);
    if (order != nullptr && find_order(scenario, results.reference) != nullptr) {
      list.push_back({&scenario, &order->speedup});
    }
  }
  return list;
}

/// Returns "8.6 % (bounce) to 16.7 % (falling)" of the absolute speedups; of one scenario just that.
std::string range_of(std::vector<Compared> list) {
  std::sort(list.begin(), list.end(), [](const Compared& a, const Compared& b) {
    return std::abs(a.speedup->percent) < std::abs(b.speedup->percent);
  });
  const auto one = [](const Compared& c) {
    return fmt::format("{:.1f} % ({})", std::abs(c.speedup->percent), c.scenario->name);
  };
  if (list.size() == 1) return one(list.front());
  return one(list.front()) + " to " + one(list.back());
}

std::string scenarios_in_words(std::size_t some, std::size_t all) {
  if (all == 1) return "in the one scenario";
  if (all == 2 && some == 2) return "in both scenarios";
  return some == all ? fmt::format("in all {} scenarios", all)
                     : fmt::format("in {} of {} scenarios", some, all);
}

/// Returns what an order gains and loses over the reference, by scenario.
std::string effect_of(const StudyResults& results, const OrderingSpec& ordering) {
  std::vector<Compared> gains;
  std::vector<Compared> losses;
  std::vector<std::string> nulls;
  const std::vector<Compared> all = compared(results, ordering.name);
  for (const Compared& c : all) {
    if (!c.speedup->beyond_noise) {
      nulls.push_back(c.scenario->name);
    } else {
      (c.speedup->percent > 0 ? gains : losses).push_back(c);
    }
  }
  std::vector<std::string> parts;
  if (!gains.empty()) {
    parts.push_back(
        fmt::format("saves time {}: {}", scenarios_in_words(gains.size(), all.size()), range_of(gains)));
  }
  if (!losses.empty()) {
    parts.push_back(
        fmt::format("loses time {}: {}", scenarios_in_words(losses.size(), all.size()), range_of(losses)));
  }
  if (!nulls.empty()) parts.push_back("differs by no more than the noise in " + in_words(nulls));
  return fmt::format("Against “{}”, {} {}.", title_of(results, results.reference),
                     title_of(results, ordering.name), fmt::join(parts, "; it "));
}

/// Returns where the paper's number for an order lies above, below or within the interval measured here.
std::string beside_paper(const StudyResults& results, const OrderingSpec& ordering) {
  if (results.reference != "scrambled") return {};
  std::vector<std::string> more;
  std::vector<std::string> less;
  std::vector<std::string> same;
  double least = 100;
  double most = -100;
  for (const Compared& c : compared(results, ordering.name)) {
    const auto saving = paper_saving(c.scenario->name, ordering.name);
    if (!saving) continue;
    least = std::min(least, saving->percent);
    most = std::max(most, saving->percent);
    const bool below = saving->percent < c.speedup->low;
    const bool above = saving->percent > c.speedup->high;
    (below ? more : above ? less : same).push_back(c.scenario->name);
  }
  const std::size_t all = more.size() + less.size() + same.size();
  const auto in = [all](const std::vector<std::string>& names) {
    return names.size() == all && all > 1 ? "in all of them" : "in " + in_words(names);
  };
  std::vector<std::string> parts;
  if (!more.empty()) parts.push_back("more " + in(more));
  if (!less.empty()) parts.push_back("less " + in(less));
  if (!same.empty()) parts.push_back("the same, within its interval, " + in(same));
  if (parts.empty()) return {};
  const std::string range =
      least == most ? fmt::format("{} %", least) : fmt::format("{} to {} %", least, most);
  return fmt::format(" The paper reports {} in these scenarios; this study finds {}.", range,
                     fmt::join(parts, ", "));
}

/// Returns when an order pays off.
std::string payment_of(const StudyResults& results, const OrderingSpec& ordering) {
  if (ordering.vertices == "original" && ordering.elements == "original") return {};
  std::vector<std::pair<Index, std::string>> paid;
  std::vector<std::string> never;
  for (const Compared& c : compared(results, ordering.name)) {
    if (!c.speedup->beyond_noise || c.speedup->percent <= 0) continue;
    if (c.speedup->break_even_step) {
      paid.emplace_back(*c.speedup->break_even_step, c.scenario->name);
    } else {
      never.push_back(c.scenario->name);
    }
  }
  if (paid.empty() && never.empty()) return {};
  std::sort(paid.begin(), paid.end());
  std::vector<std::string> parts;
  if (!paid.empty()) {
    std::string steps =
        fmt::format("pays off after {} step{}", paid.front().first, paid.front().first == 1 ? "" : "s");
    if (paid.size() > 1) {
      steps = paid.front().first == paid.back().first
                  ? steps
                  : fmt::format("pays off after {} ({}) to {} steps ({})", paid.front().first,
                                paid.front().second, paid.back().first, paid.back().second);
    }
    parts.push_back(steps);
  }
  if (!never.empty()) parts.push_back("does not pay off within the steps of " + in_words(never));
  return fmt::format(" Where it saves time, computing the order {}.", fmt::join(parts, ", and "));
}

/// Returns a caution if the study is shorter than the paper's.
std::string caution(const StudyResults& results) {
  const auto shorter = [](const ScenarioRecord& scenario) { return scenario.steps < kPaperSteps; };
  const bool few_steps = std::any_of(results.scenarios.begin(), results.scenarios.end(), shorter);
  if (results.scenarios.empty() || (!few_steps && results.runs >= 3)) return {};
  Index least = kMaxIndex;
  for (const ScenarioRecord& scenario : results.scenarios) least = std::min(least, scenario.steps);
  return fmt::format(
      "This is a first look, of {} steps and {} run{}. The paper's study has {} steps and 3 runs, and "
      "later steps may cost more or less than the first ones.",
      least, results.runs, results.runs == 1 ? "" : "s", kPaperSteps);
}

/// Returns the largest distance between the motions of a scenario's orders, as a share of the body's size, if
/// known.
std::optional<double> largest_difference(const ScenarioRecord& scenario) {
  std::optional<double> largest;
  for (const ScenarioOrderRecord& order : scenario.orders) {
    if (!order.motion.by_frame.empty()) largest = std::max(largest.value_or(0), order.motion.largest);
  }
  return largest;
}

std::string same_motion(const StudyResults& results) {
  constexpr double kSeen = 0.01;
  std::vector<std::string> parted;
  double largest = 0;
  std::string where;
  bool known = false;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const std::optional<double> difference = largest_difference(scenario);
    if (!difference) continue;
    known = true;
    if (*difference >= kSeen) {
      parted.push_back(
          fmt::format("{} (by {:.1f} % of the body's longest side)", scenario.name, 100 * *difference));
    } else if (*difference >= largest) {
      largest = *difference;
      where = scenario.name;
    }
  }
  if (!known) return {};
  std::string same;
  if (!where.empty()) {
    same = largest == 0
               ? "The motions are the same in every order, to the last bit that was stored."
               : fmt::format(
                     "The motion is the same in every order{}: positions differ by at most {:.1e} of "
                     "the body's longest side, in {}.",
                     parted.empty() ? "" : " of most scenarios", largest, where);
  }
  if (parted.empty()) return same;
  return fmt::format(
      "{}{}The motions differ in {}: rounding depends on the order, and contacts amplify it. Their times are "
      "not for exactly the same work.",
      same, same.empty() ? "" : " ", in_words(parted));
}

/// Returns where an order's iterations differ from the reference's by 1 % or more: there the difference in
/// time is not due to memory alone.
std::string other_work(const StudyResults& results) {
  std::vector<std::string> where;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const ScenarioOrderRecord* const reference = find_order(scenario, results.reference);
    if (reference == nullptr) continue;
    const double whole = mean_iterations(*reference);
    for (const OrderingSpec& ordering : results.orderings) {
      const ScenarioOrderRecord* const order = find_order(scenario, ordering.name);
      if (order == nullptr || whole <= 0) continue;
      const double percent = 100 * (mean_iterations(*order) / whole - 1);
      if (std::abs(percent) >= 1) {
        where.push_back(fmt::format("{}, {} ({} %)", scenario.name, title_of(results, ordering.name),
                                    signed_percent(percent)));
      }
    }
  }
  if (where.empty()) return {};
  return fmt::format(
      "Where an order takes a different number of iterations, memory is not the only cause of a difference: "
      "{}.",
      fmt::join(where, "; "));
}

/// Returns what the paper's two orders, Fiedler and VF Fiedler, save over scrambled vertices in its
/// scenarios, with what it reports. Empty unless the study has one of them and that reference.
std::string headline(const StudyResults& results) {
  if (results.reference != "scrambled") return {};
  const Effect vertices = paper_effect(results, "fiedler");
  const Effect both = paper_effect(results, "vf-fiedler");
  if (vertices.here.empty() && both.here.empty()) return {};
  std::string here = "Ordering vertices by the Fiedler vector saves " + percents(vertices.here);
  std::string paper = percents(vertices.paper);
  if (vertices.here.empty()) {
    here = "Ordering vertices and elements by their Fiedler vectors saves " + percents(both.here);
    paper = percents(both.paper);
  } else if (!both.here.empty()) {
    here += ", and ordering elements as well " + percents(both.here) + ",";
    paper += " and " + percents(both.paper);
  }
  return fmt::format(
      "{} of the time that the same simulations take with scrambled vertices. The paper, with other "
      "simulators on a Xeon with 10 MB of cache, reports {}.",
      here, paper);
}

/// Returns what the VF Fiedler order saves over scrambled vertices and elements, which the paper does not
/// compare. Empty unless the study has both.
std::string against_all_scrambled(const StudyResults& results) {
  Range saved;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const ScenarioOrderRecord* const ordered = find_order(scenario, "vf-fiedler");
    const ScenarioOrderRecord* const scrambled = find_order(scenario, "vf-scrambled");
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
  return "If elements are scrambled too, a reference that the paper does not use, there is more to gain: VF "
         "Fiedler saves " +
         range + " of the time of VF scrambled.";
}

}  // namespace

std::vector<std::string> findings_of(const StudyResults& results) {
  std::vector<std::string> findings{headline(results), caution(results)};
  for (const OrderingSpec& ordering : results.orderings) {
    if (ordering.name == results.reference || compared(results, ordering.name).empty()) continue;
    findings.push_back(effect_of(results, ordering) + beside_paper(results, ordering) +
                       payment_of(results, ordering));
  }
  findings.push_back(against_all_scrambled(results));
  findings.push_back(same_motion(results));
  findings.push_back(other_work(results));
  std::ranges::move(mesh_findings(results), std::back_inserter(findings));
  std::erase(findings, "");
  return findings;
}

}  // namespace meshorder
