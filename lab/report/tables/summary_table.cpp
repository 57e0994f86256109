// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/findings/paper.hpp"
#include "lab/report/tables/each_table.hpp"
#include "lab/report/tables/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace meshorder {
namespace {

/// Returns whether an order is not the reference, and some scenario was run both in this order and in the
/// reference.
bool is_compared(const StudyResults& results, const std::string& ordering) {
  return ordering != results.reference &&
         std::any_of(results.scenarios.begin(), results.scenarios.end(), [&](const ScenarioRecord& scenario) {
           return find_order(scenario, ordering) != nullptr &&
                  find_order(scenario, results.reference) != nullptr;
         });
}

/// Returns whether the paper has a number for an order in one of the scenarios.
bool has_paper_of(const StudyResults& results, const std::string& ordering) {
  return has_paper(results) &&
         std::any_of(results.scenarios.begin(), results.scenarios.end(), [&](const ScenarioRecord& scenario) {
           return paper_saving(scenario.name, ordering).has_value();
         });
}

}  // namespace

TableCell paper_cell(std::string_view scenario, std::string_view ordering) {
  const auto saving = paper_saving(scenario, ordering);
  if (!saving) return unknown_cell();
  return {fmt::format("+{}", saving->percent), saving->percent, false};
}

TableCell saving_cell(const Speedup& speedup) {
  TableCell cell = percent_cell(speedup.percent);
  if (speedup.low < speedup.high)
    cell.interval = fmt::format("{} … {}", signed_percent(speedup.low), signed_percent(speedup.high));
  cell.certainty = !speedup.beyond_noise ? Certainty::open
                   : speedup.percent > 0 ? Certainty::saves
                                         : Certainty::costs;
  return cell;
}

Table summary_table(const StudyResults& results) {
  Table table{"summary",
              "What the orders save",
              fmt::format("Per cent of the time that the same steps take in the order “{}”, with the 95 % "
                          "confidence interval. Saves, costs: the interval lies on one side of 0. No "
                          "clear difference: it holds 0, or one run was too short for an interval.",
                          title_of(results, results.reference)),
              {"Scenario"},
              {}};
  std::vector<const OrderingSpec*> orderings;
  for (const OrderingSpec& ordering : results.orderings) {
    if (!is_compared(results, ordering.name)) continue;
    orderings.push_back(&ordering);
    table.columns.push_back(title_of(results, ordering.name));
    if (has_paper_of(results, ordering.name)) table.columns.push_back(table.columns.back() + ", paper");
  }
  if (orderings.empty()) return table;
  if (has_paper(results)) {
    table.caption +=
        " Paper: other simulators on a Xeon with 10 MB of cache." + differences_from_paper(results);
  }
  for (const ScenarioRecord& scenario : results.scenarios) {
    if (find_order(scenario, results.reference) == nullptr) continue;
    std::vector<TableCell> row{text_cell(scenario.name)};
    for (const OrderingSpec* const ordering : orderings) {
      const ScenarioOrderRecord* const order = find_order(scenario, ordering->name);
      row.push_back(order == nullptr ? unknown_cell() : saving_cell(order->speedup));
      if (has_paper_of(results, ordering->name)) row.push_back(paper_cell(scenario.name, ordering->name));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<Table> tables_of(const StudyResults& results) {
  std::vector<Table> tables{summary_table(results), edge_span_table(results), seconds_table(results),
                            saved_table(results),   speedup_table(results),   break_even_table(results),
                            phases_table(results),  motions_table(results)};
  std::ranges::move(misses_tables(results), std::back_inserter(tables));
  tables.push_back(prediction_table(results));
  tables.push_back(kernels_table(results));
  tables.push_back(machine_table(results));
  tables.push_back(protocol_table(results));
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

}  // namespace meshorder
