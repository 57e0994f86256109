// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/comparison/comparison.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/findings/paper.hpp"
#include "lab/report/tables/each_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace meshorder {
namespace {

/// Returns "A saves more", "B saves more" or "not told apart".
TableCell words_cell(const std::optional<SavingDifference>& difference) {
  if (!difference || !difference->beyond_noise) {
    TableCell cell = text_cell("not told apart");
    cell.weak = true;
    return cell;
  }
  return text_cell(difference->points > 0 ? "B saves more" : "A saves more");
}

TableCell difference_cell(const ComparedOrder& order) {
  TableCell cell = percent_cell(order.b.percent - order.a.percent);
  if (order.difference) {
    cell.interval =
        fmt::format("{} … {}", signed_percent(order.difference->low), signed_percent(order.difference->high));
  }
  cell.weak = !order.difference || !order.difference->beyond_noise;
  return cell;
}

Table savings_table(const StudyResults& a, const StudyResults& b) {
  const bool paper = has_paper(a);
  Table table{
      "comparison",
      "What the orders save in both studies",
      fmt::format(
          "Per cent of the time that the same steps take in the order “{}”, with 95 % confidence "
          "intervals. Saves, costs: the interval lies on one side of 0. No clear difference: it holds 0, "
          "or there is none. B − A: percentage points, with the interval that follows from both.",
          title_of(a, a.reference)),
      {"Scenario and order", "A, %", "B, %", "B − A", "In words"},
      {}};
  if (paper) table.columns.emplace_back("Paper, %");
  for (const ComparedOrder& order : compared_orders(a, b)) {
    table.rows.push_back({text_cell(fmt::format("{}, {}", order.scenario, title_of(a, order.ordering))),
                          saving_cell(order.a), saving_cell(order.b), difference_cell(order),
                          words_cell(order.difference)});
    if (paper) table.rows.back().push_back(paper_cell(order.scenario, order.ordering));
  }
  return table;
}

Table reference_table(const StudyResults& a, const StudyResults& b) {
  const std::string reference = title_of(a, a.reference);
  Table table{
      "comparison-seconds",
      fmt::format("Seconds of a step in the order “{}”", reference),
      "Mean of all steps and runs. A over B: how many times as long a step takes in A; of scenarios with the "
      "same number of steps.",
      {"Scenario", "A, steps", "A, s", "B, steps", "B, s", "A over B"},
      {}};
  for (const ScenarioRecord& scenario : a.scenarios) {
    const ScenarioRecord* const other = find_named(b.scenarios, scenario.name);
    const auto* const of_a = find_order(scenario, a.reference);
    const auto* const of_b = other == nullptr ? nullptr : find_order(*other, b.reference);
    if (of_a == nullptr || of_b == nullptr) continue;
    const double step_a = of_a->time.mean / scenario.steps;
    const double step_b = of_b->time.mean / other->steps;
    const bool same = scenario.steps == other->steps && step_b > 0;
    table.rows.push_back({text_cell(scenario.name), count_cell(scenario.steps), number_cell(step_a, 3),
                          count_cell(other->steps), number_cell(step_b, 3),
                          same ? number_cell(step_a / step_b, 3) : unknown_cell()});
  }
  return table;
}

TableCell speedup_cell(const MeshRecord& mesh, const std::string& ordering, const std::string& reference,
                       std::size_t kernel) {
  const MeshOrderRecord* const order = find_order(mesh, ordering);
  const MeshOrderRecord* const whole = find_order(mesh, reference);
  if (order == nullptr || whole == nullptr) return unknown_cell();
  const double ms = order->kernels[kernel].measured_ms;
  const double whole_ms = whole->kernels[kernel].measured_ms;
  if (ms <= 0 || whole_ms <= 0) return unknown_cell();
  return {fmt::format("{:.2f}×", whole_ms / ms), whole_ms / ms, false};
}

Table both_kernels_table(const StudyResults& a, const StudyResults& b) {
  Table table{"comparison-kernels",
              "Measured speedups of the kernels",
              fmt::format("How many times faster than in the order “{}” a kernel runs on one thread, best of "
                          "interleaved rounds.",
                          title_of(a, a.reference)),
              {"Mesh, kernel and order", "A", "B"},
              {}};
  for (const MeshRecord& mesh : a.meshes) {
    const MeshRecord* const other = find_named(b.meshes, mesh.name);
    if (other == nullptr) continue;
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      for (const OrderingSpec& ordering : a.orderings) {
        if (ordering.name == a.reference) continue;
        TableCell of_a = speedup_cell(mesh, ordering.name, a.reference, k);
        TableCell of_b = speedup_cell(*other, ordering.name, b.reference, k);
        if (!of_a.value || !of_b.value) continue;
        table.rows.push_back(
            {text_cell(fmt::format("{}, {}, {}", mesh.name, kKernelTitles[k], title_of(a, ordering.name))),
             std::move(of_a), std::move(of_b)});
      }
    }
  }
  return table;
}

/// Returns the second cell of the row with this head; a dash if the table has no such row.
TableCell cell_of(const Table& table, const std::string& head) {
  for (const auto& row : table.rows) {
    if (row.front().text == head) return row[1];
  }
  return unknown_cell();
}

/// Returns the tables `machine` and `protocol` of both studies side by side.
Table machines_table(const ComparedStudy& a, const ComparedStudy& b) {
  Table table{"comparison-machines",
              "Machines, programs and dates",
              "",
              {"What", "A", "B", "Same"},
              {{text_cell("Results"), text_cell(a.file), text_cell(b.file), unknown_cell()}}};
  for (const auto make_table : {&machine_table, &protocol_table}) {
    const Table of_a = make_table(a.results);
    const Table of_b = make_table(b.results);
    std::vector<std::string> heads;
    for (const Table* const both : {&of_a, &of_b}) {
      for (const auto& row : both->rows) {
        if (std::find(heads.begin(), heads.end(), row.front().text) == heads.end())
          heads.push_back(row.front().text);
      }
    }
    for (const std::string& head : heads) {
      TableCell left = cell_of(of_a, head);
      TableCell right = cell_of(of_b, head);
      left.value.reset();  // the columns mix words and numbers
      right.value.reset();
      TableCell same = text_cell(left.text == right.text ? "same" : "differs");
      same.weak = left.text == right.text;
      table.rows.push_back({text_cell(head), std::move(left), std::move(right), std::move(same)});
    }
  }
  return table;
}

}  // namespace

std::vector<Table> comparison_tables(const ComparedStudy& a, const ComparedStudy& b) {
  std::vector<Table> tables{savings_table(a.results, b.results), machines_table(a, b),
                            reference_table(a.results, b.results), both_kernels_table(a.results, b.results)};
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace meshorder
