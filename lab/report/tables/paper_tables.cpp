// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/findings/paper.hpp"
#include "lab/report/tables/each_table.hpp"
#include "payoff/quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

constexpr const char* kHead = "Scenario and order";

/// Returns a cell for seconds that are derived from rounded numbers: rounded to 1, or to 10 from 1000 on.
TableCell derived_cell(const std::optional<double>& seconds) {
  if (!seconds) return unknown_cell();
  const double unit = *seconds < 1000 ? 1 : 10;
  return {fmt::format("≈ {}", with_commas(std::llround(*seconds / unit) * static_cast<long long>(unit))),
          seconds, false};
}

/// Returns seconds that are a part of `whole`, with as many decimals as `whole`.
TableCell part_cell(double seconds, double whole) {
  return {with_digits_of(seconds, whole, 4), seconds, false};
}

/// Returns a number as the paper prints it.
TableCell printed_cell(double number) { return {fmt::format("{}", number), number, false}; }

}  // namespace

bool has_paper(const StudyResults& results) {
  return results.reference == "scrambled" &&
         std::any_of(results.scenarios.begin(), results.scenarios.end(), [](const ScenarioRecord& scenario) {
           return find_paper_scenario(scenario.name) != nullptr;
         });
}

std::string differences_from_paper(const StudyResults& results) {
  std::string words;
  for (const ScenarioRecord& scenario : results.scenarios) {
    const PaperScenario* const paper = find_paper_scenario(scenario.name);
    if (paper == nullptr) continue;
    const bool other_mesh = scenario.mesh != paper->mesh || results.size != "paper";
    if (scenario.steps == kPaperSteps && !other_mesh) continue;
    words += fmt::format("{} {}", words.empty() ? " Not as in the paper:" : ";", scenario.name);
    if (scenario.steps != kPaperSteps) words += fmt::format(", {} steps", scenario.steps);
    if (other_mesh) words += fmt::format(", on {}", scenario.mesh);
  }
  return words + (words.empty() ? "" : ".");
}

Table edge_span_table(const StudyResults& results) {
  Table table{
      "table-1",
      "Table 1: edge spans",
      "Distance in memory between the ends of an edge, in vertices: mean over all edges, and largest. The "
      "mean span of a random order is a third of the number of vertices. The paper's text does not give "
      "its numbers; it says that the Fiedler order's mean is about two orders of magnitude below the "
      "scrambled one's.",
      {"Mesh and order", "Mean span", "% of a random order's", "Largest span"},
      {}};
  for (const MeshRecord& mesh : results.meshes) {
    for (const OrderingSpec& ordering : results.orderings) {
      const MeshOrderRecord* const order = find_order(mesh, ordering.name);
      if (order == nullptr) continue;
      const double random = (mesh.vertices + 1.0) / 3.0;
      table.rows.push_back({text_cell(fmt::format("{}, {}", mesh.name, title_of(results, ordering.name))),
                            number_cell(order->span.mean), number_cell(100 * order->span.mean / random, 3),
                            count_cell(order->span.max)});
    }
  }
  return table;
}

Table seconds_table(const StudyResults& results) {
  const bool paper = has_paper(results);
  Table table{"table-2",
              "Table 2: seconds",
              fmt::format("Seconds of a scenario's steps without set-up: mean and standard deviation of the "
                          "runs ({}).",
                          results.runs),
              {kHead, "Mean, s", "± s"},
              {}};
  if (paper) {
    table.columns.emplace_back("Paper, s");
    table.caption += fmt::format(
        " The paper's are derived: seconds saved divided by the per cent saved give those of its scrambled "
        "order, good to half a per cent, for {} steps (three runs, or five: it says both).{}{}",
        kPaperSteps, differences_from_paper(results), kNotTold);
  }
  for_each_order(results, false, [&](const ScenarioRecord& scenario, const ScenarioOrderRecord& order) {
    table.rows.push_back({head_of(results, scenario, order), number_cell(order.time.mean),
                          order.runs.size() > 1 ? number_cell(order.time.deviation, 2) : unknown_cell()});
    if (paper) table.rows.back().push_back(derived_cell(paper_seconds(scenario.name, order.ordering)));
  });
  return table;
}

Table saved_table(const StudyResults& results) {
  const bool paper = has_paper(results);
  Table table{
      "table-3",
      "Table 3: seconds saved",
      fmt::format("The mean seconds of “{}” minus those of each order; negative if the order is slower.",
                  title_of(results, results.reference)),
      {kHead, "Saved, s"},
      {}};
  if (paper) {
    table.columns.emplace_back("Paper, s");
    table.caption += fmt::format(" The paper's {} steps on its Xeon.{}{}", kPaperSteps,
                                 differences_from_paper(results), kNotTold);
  }
  for_each_order(results, true, [&](const ScenarioRecord& scenario, const ScenarioOrderRecord& order) {
    table.rows.push_back(
        {head_of(results, scenario, order),
         part_cell(order.speedup.saved_seconds, order.time.mean + order.speedup.saved_seconds)});
    table.rows.back().back().weak = !order.speedup.beyond_noise;
    if (!paper) return;
    const auto saving = paper_saving(scenario.name, order.ordering);
    table.rows.back().push_back(saving ? printed_cell(saving->seconds) : unknown_cell());
  });
  return table;
}

Table speedup_table(const StudyResults& results) {
  const bool paper = has_paper(results);
  Table table{"table-4",
              "Table 4: speedups in per cent",
              fmt::format("Time saved in per cent of that of “{}”, with its 95 % confidence interval. Within "
                          "noise: the interval contains 0. Undisturbed: from the fastest run of every step.",
                          title_of(results, results.reference)),
              {kHead, "Speedup, %", "95 % from", "95 % to", "In words", "Undisturbed, %"},
              {}};
  if (paper) {
    table.columns.insert(table.columns.begin() + 2, "Paper, %");
    table.caption += differences_from_paper(results) + kNotTold;
  }
  for_each_order(results, true, [&](const ScenarioRecord& scenario, const ScenarioOrderRecord& order) {
    const Speedup& s = order.speedup;
    const std::string words = !s.beyond_noise ? "not told apart" : s.percent > 0 ? "gain" : "loss";
    std::vector<TableCell> row{head_of(results, scenario, order),
                               percent_cell(s.percent),
                               percent_cell(s.low),
                               percent_cell(s.high),
                               text_cell(words),
                               percent_cell(s.undisturbed_percent)};
    for (std::size_t i = 1; i <= 4; ++i) row[i].weak = !s.beyond_noise;
    if (paper) row.insert(row.begin() + 2, paper_cell(scenario.name, order.ordering));
    table.rows.push_back(std::move(row));
  });
  return table;
}

Table break_even_table(const StudyResults& results) {
  Table table{
      "break-even",
      "What an order costs, and when it pays off",
      fmt::format("Seconds to compute the order and move the mesh, and the first step by whose end the steps "
                  "have saved as much, compared with “{}”.",
                  title_of(results, results.reference)),
      {kHead, "Cost, s", "Pays off at step", "Of steps"},
      {}};
  for_each_order(results, true, [&](const ScenarioRecord& scenario, const ScenarioOrderRecord& order) {
    const MeshRecord* const mesh = find_named(results.meshes, scenario.mesh);
    const MeshOrderRecord* const of_mesh = mesh == nullptr ? nullptr : find_order(*mesh, order.ordering);
    const auto& step = order.speedup.break_even_step;
    TableCell paid{"never", std::nullopt, true};
    if (step) paid = count_cell(*step);
    paid.weak = !step || !order.speedup.beyond_noise;
    table.rows.push_back({head_of(results, scenario, order),
                          of_mesh == nullptr ? unknown_cell() : number_cell(of_mesh->seconds, 3), paid,
                          count_cell(scenario.steps)});
  });
  return table;
}

}  // namespace meshorder
