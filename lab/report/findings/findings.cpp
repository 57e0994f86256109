// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/findings.hpp"

#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/findings/paper.hpp"
#include "lab/study/statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

/// The least and the greatest of the values added, with their names.
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

/// Returns a sentence on when the orders that save time pay off.
std::string payments(const StudyResults& results) {
  struct Payment {
    Index step;
    std::string where;
  };
  std::vector<Payment> paid;
  std::vector<std::string> never;
  for (const OrderingSpec& ordering : results.orderings) {
    if (ordering.name == results.reference) continue;
    if (ordering.vertices == "original" && ordering.elements == "original") continue;
    for (const Compared& c : compared(results, ordering.name)) {
      if (!c.speedup->beyond_noise || c.speedup->percent <= 0) continue;
      std::string where = fmt::format("{} in {}", title_of(results, ordering.name), c.scenario->name);
      if (c.speedup->break_even_step) {
        paid.push_back({*c.speedup->break_even_step, std::move(where)});
      } else {
        never.push_back(std::move(where));
      }
    }
  }
  std::stable_sort(paid.begin(), paid.end(),
                   [](const Payment& a, const Payment& b) { return a.step < b.step; });
  if (paid.empty() && never.empty()) return {};
  std::string words = "Where an order saves time, computing it ";
  if (paid.empty()) return words + "does not pay off within the measured steps: " + in_words(never) + ".";
  const Payment& first = paid.front();
  const Payment& last = paid.back();
  words += first.step == last.step
               ? fmt::format("pays off after {} step{}", first.step, first.step == 1 ? "" : "s")
               : fmt::format("pays off after {} ({}) to {} steps ({})", first.step, first.where, last.step,
                             last.where);
  if (!never.empty()) words += ", but not within the measured steps for " + in_words(never);
  return words + ".";
}

/// Returns sentences on the runs that are shorter or fewer than in the paper's study; empty if none are.
std::string caution(const StudyResults& results) {
  std::vector<std::string> shorter;
  for (const ScenarioRecord& scenario : results.scenarios) {
    if (scenario.steps < kPaperSteps)
      shorter.push_back(fmt::format("{} ({} steps)", scenario.name, scenario.steps));
  }
  const bool few_runs = results.runs < 3;
  if (results.scenarios.empty() || (shorter.empty() && !few_runs)) return {};
  std::string words =
      fmt::format("This study is shorter than the paper's of {} steps and 3 runs: ", kPaperSteps);
  if (few_runs) words += fmt::format("{} run{}", results.runs, results.runs == 1 ? "" : "s");
  if (shorter.empty()) return words + ".";
  if (few_runs) words += "; ";
  return words + in_words(shorter) + ". Later steps may cost more or less than the first ones.";
}

/// Returns a sentence on the load and the throttling of the machine; empty if the study did not record them.
std::string load_in_words(const StudyResults& results) {
  double seconds = 0;
  double of_others = 0;
  Range share;
  Range pace;
  for (const ScenarioRecord& scenario : results.scenarios) {
    for (const ScenarioOrderRecord& order : scenario.orders) {
      const std::string where = fmt::format("{} in {}", title_of(results, order.ordering), scenario.name);
      for (const RunRecord& run : order.runs) {
        if (run.pace_seconds.empty()) continue;
        const double of_run = std::accumulate(run.step_seconds.begin(), run.step_seconds.end(), 0.0);
        const double available = std::max(1, results.machine.cores) * std::max(of_run, 1e-9);
        share.add(std::min(1.0, run.other_seconds / available), where);
        for (const double one : run.pace_seconds) pace.add(one, where);
        seconds += available;
        of_others += run.other_seconds;
      }
    }
  }
  if (share.empty()) return {};
  std::string words = fmt::format(
      "Load: other programs used {:.0f} % of the processors during the runs, at most {:.0f} % ({})",
      100 * std::min(1.0, of_others / seconds), 100 * share.most, share.most_name);
  words += fmt::format("; a fixed piece of arithmetic took up to {:.0f} % longer than at best ({}).",
                       100 * (pace.most / std::max(pace.least, 1e-9) - 1), pace.most_name);
  return words;
}

/// Returns the largest distance from the first order's motion, over all orders of a scenario, as a share of
/// the body's longest side; empty if not known.
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
      "{}{}The motions differ in {}: rounding depends on the order, and contacts amplify it. "
      "Their times are "
      "not for exactly the same work.",
      same, same.empty() ? "" : " ", in_words(parted));
}

/// Returns a sentence on the orders whose iteration counts differ from the reference's by 1 % or more: their
/// difference in time is not due to memory alone.
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

/// Returns what the VF Fiedler order saves over scrambled vertices and elements, which the paper does not
/// compare. Empty unless the study has both.
std::string against_all_scrambled(const StudyResults& results) {
  Range saved;
  for (const ScenarioRecord& scenario : results.scenarios) {
    if (scenario.method == "particle-fem") continue;  // a fluid's elements are ordered in each step
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
  std::vector<std::string> findings{caution(results),     load_in_words(results),
                                    payments(results),    against_all_scrambled(results),
                                    same_motion(results), other_work(results)};
  std::ranges::move(mesh_findings(results), std::back_inserter(findings));
  std::erase(findings, "");
  return findings;
}

}  // namespace meshorder
