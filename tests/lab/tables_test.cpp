// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/tables/tables.hpp"

#include "support/sample_results.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace meshorder;
using test::sample_results;

const Table* find_table(const std::vector<Table>& tables, const std::string& id) {
  for (const Table& table : tables) {
    if (table.id == id) return &table;
  }
  return nullptr;
}

/// The cell of a row and a column by their heads.
TableCell cell(const std::vector<Table>& tables, const std::string& id, const std::string& row,
               const std::string& column) {
  const Table* const table = find_table(tables, id);
  if (table == nullptr) throw std::runtime_error("no table " + id);
  for (std::size_t c = 0; c < table->columns.size(); ++c) {
    if (table->columns[c] != column) continue;
    for (const auto& cells : table->rows) {
      if (cells.front().text == row) return cells[c];
    }
  }
  throw std::runtime_error("no cell " + row + " | " + column + " in " + id);
}

std::vector<std::string> ids(const std::vector<Table>& tables) {
  std::vector<std::string> result;
  for (const Table& table : tables) result.push_back(table.id);
  return result;
}

TEST(Tables, HoldTheResultsNumbersToTheLastBit) {
  StudyResults results = sample_results();
  ScenarioOrderRecord& order = results.scenarios[1].orders[1];
  order.time = {87.123456789012345, 1.0 / 3, 0};
  order.speedup = {1.0 / 7, 2.0 / 7, 3.0 / 7, 4.0 / 7, true, 5.0 / 7, 3};
  results.meshes[0].orders[1].seconds = 1.0 / 9;
  results.meshes[0].orders[1].span = {1.0 / 11, 74, 0};
  const auto tables = tables_of(results);
  const auto value = [&tables](const char* id, const char* row, const char* column) {
    return cell(tables, id, row, column).value;
  };
  EXPECT_EQ(value("table-1", "dragon, Fiedler", "Mean span"), 1.0 / 11);
  EXPECT_EQ(value("table-1", "dragon, Fiedler", "Largest span"), 74);
  EXPECT_EQ(value("table-2", "stretch, Fiedler", "Mean, s"), 87.123456789012345);
  EXPECT_EQ(value("table-2", "stretch, Fiedler", "± s"), 1.0 / 3);
  EXPECT_EQ(value("table-3", "stretch, Fiedler", "Saved, s"), 1.0 / 7);
  EXPECT_EQ(value("table-4", "stretch, Fiedler", "Speedup, %"), 2.0 / 7);
  EXPECT_EQ(value("table-4", "stretch, Fiedler", "95 % from"), 3.0 / 7);
  EXPECT_EQ(value("table-4", "stretch, Fiedler", "95 % to"), 4.0 / 7);
  EXPECT_EQ(value("table-4", "stretch, Fiedler", "Undisturbed, %"), 5.0 / 7);
  EXPECT_EQ(value("break-even", "stretch, Fiedler", "Cost, s"), 1.0 / 9);
  EXPECT_EQ(value("break-even", "stretch, Fiedler", "Pays off at step"), 3);
}

TEST(Tables, RoundToDigitsThatMeanSomething) {
  const auto tables = tables_of(sample_results());
  const auto text = [&tables](const char* id, const char* row, const char* column) {
    return cell(tables, id, row, column).text;
  };
  EXPECT_EQ(text("table-1", "dragon, Scrambled", "Mean span"), "100.0");
  EXPECT_EQ(text("table-1", "dragon, Fiedler", "% of a random order's"), "24.9");  // of 301/3
  EXPECT_EQ(text("table-2", "falling, Fiedler", "Mean, s"), "75.00");
  EXPECT_EQ(text("table-2", "falling, Fiedler", "± s"), "0.50");
  EXPECT_EQ(text("table-3", "falling, VF scrambled", "Saved, s"), "−2.0");
  EXPECT_EQ(text("table-4", "falling, Fiedler", "Speedup, %"), "+25.0");
  EXPECT_EQ(text("table-4", "falling, VF scrambled", "95 % from"), "−3.0");
  EXPECT_EQ(text("break-even", "falling, VF Fiedler", "Cost, s"), "0.500");
  EXPECT_EQ(text("phases", "falling, Fiedler", "By element, s"), "18.75");  // a quarter of 75
  EXPECT_EQ(text("phases", "falling, Fiedler", "System, s"), "37.50");
  EXPECT_EQ(text("phases", "falling, Fiedler", "Other, s"), "18.75");
  EXPECT_EQ(text("phases", "stretch, Fiedler", "Iterations"), "80");
  EXPECT_EQ(text("motions", "stretch, Fiedler", "Largest difference"), "2.0e-12");
  EXPECT_EQ(text("misses-1", "dragon, SpMV, Fiedler", "L3 32 MB"), "5 (0.25×)");
  EXPECT_EQ(text("misses-2", "dragon, springs, Scrambled", "L3 10 MB"), "50");
  EXPECT_EQ(text("kernels", "dragon, assembly, Original", "Predicted"), "2.00×");
  EXPECT_EQ(text("kernels", "dragon, assembly, Original", "Measured, ms"), "0.500");
  EXPECT_EQ(text("machine", "Memory", "Is"), "8 GB");
  EXPECT_EQ(text("protocol", "Order VF Fiedler", "Is"), "vertices fiedler, elements fiedler");
}

TEST(Tables, ShowThePapersFiguresAndSayWhereItHasNone) {
  const auto tables = tables_of(sample_results());
  EXPECT_EQ(cell(tables, "table-4", "falling, VF Fiedler", "Paper, %").text, "+27.8");
  EXPECT_EQ(cell(tables, "table-3", "stretch, VF Fiedler", "Paper, s").text, "108.2");
  EXPECT_EQ(cell(tables, "table-2", "stretch, Scrambled", "Paper, s").text, "≈ 425");
  const TableCell unknown = cell(tables, "table-4", "falling, VF scrambled", "Paper, %");
  EXPECT_EQ(unknown.text, "–");
  EXPECT_TRUE(unknown.weak);
  EXPECT_FALSE(unknown.value);
  for (const char* id : {"table-2", "table-3", "table-4"}) {
    const std::string& caption = find_table(tables, id)->caption;
    EXPECT_NE(caption.find("–: the paper's text gives no number"), std::string::npos) << caption;
    EXPECT_NE(caption.find("Not as in the paper: falling, 4 steps; stretch, 4 steps."), std::string::npos);
  }
}

TEST(Tables, AreWithoutThePaperWhereItsFiguresSayNothing) {
  StudyResults results = sample_results();
  for (ScenarioRecord& scenario : results.scenarios) scenario.name = "my-" + scenario.name;
  const auto tables = tables_of(results);
  for (const char* id : {"table-2", "table-3", "table-4"}) {
    const Table& table = *find_table(tables, id);
    for (const std::string& column : table.columns) EXPECT_EQ(column.find("Paper"), std::string::npos);
    EXPECT_EQ(table.caption.find("aper"), std::string::npos) << table.caption;
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size());
  }
}

TEST(Tables, SayWhereTheNoiseSwallowsADifference) {
  const auto tables = tables_of(sample_results());
  const TableCell noise = cell(tables, "table-4", "stretch, Original", "In words");
  EXPECT_EQ(noise.text, "not told apart");
  EXPECT_TRUE(noise.weak);
  EXPECT_TRUE(cell(tables, "table-4", "stretch, Original", "Speedup, %").weak);
  EXPECT_TRUE(cell(tables, "table-3", "stretch, Original", "Saved, s").weak);
  EXPECT_EQ(cell(tables, "table-4", "stretch, Fiedler", "In words").text, "gain");
  EXPECT_FALSE(cell(tables, "table-4", "stretch, Fiedler", "Speedup, %").weak);
  EXPECT_EQ(cell(tables, "table-4", "stretch, VF scrambled", "In words").text, "loss");
  EXPECT_EQ(cell(tables, "break-even", "stretch, VF Fiedler", "Pays off at step").text, "never");
}

TEST(Tables, BeginWithWhatEachOrderSavesInEachScenario) {
  const auto tables = tables_of(sample_results());
  const Table& summary = tables.front();
  ASSERT_EQ(summary.id, "summary");
  EXPECT_EQ(summary.columns,
            (std::vector<std::string>{"Scenario", "Original", "Original, paper", "Fiedler", "Fiedler, paper",
                                      "VF Fiedler", "VF Fiedler, paper", "VF scrambled"}));
  ASSERT_EQ(summary.rows.size(), 2);
  const auto at = [&](const char* row, const char* column) { return cell(tables, "summary", row, column); };
  const TableCell saves = at("falling", "Fiedler");
  EXPECT_EQ(saves.text, "+25.0");
  EXPECT_EQ(saves.value, 25);
  EXPECT_EQ(saves.interval, "+24.0 … +26.0");
  EXPECT_EQ(saves.certainty, Certainty::saves);
  EXPECT_EQ(at("falling", "Fiedler, paper").text, "+26.7");
  EXPECT_EQ(at("stretch", "Original").interval, "−0.5 … +1.5");
  EXPECT_EQ(at("stretch", "Original").certainty, Certainty::open);
  EXPECT_EQ(at("stretch", "VF scrambled").interval, "−7.0 … −5.0");
  EXPECT_EQ(at("stretch", "VF scrambled").certainty, Certainty::costs);
  EXPECT_EQ(at("stretch", "VF scrambled").text, "−6.0");
}

TEST(Tables, SayWhatIsCertainInEveryFormat) {
  Table table{"t", "T", "", {"Scenario", "Order"}, {}};
  const TableCell saves{"+3.0", 3, false, "+2.0 … +4.0", Certainty::saves};
  const TableCell open{"+1.0", 1, false, "−1.0 … +3.0", Certainty::open};
  const TableCell costs{"−3.0", -3, false, "", Certainty::costs};
  for (const TableCell& each : {saves, open, costs}) table.rows.push_back({{"s", {}, false}, each});
  EXPECT_EQ(to_markdown({table}),
            "## T\n\n| Scenario | Order |\n| --- | ---: |\n| s | +3.0 (+2.0 … +4.0), saves |\n"
            "| s | +1.0 (−1.0 … +3.0), not told apart |\n| s | −3.0, costs |\n");
  EXPECT_NE(to_csv({table}).find("t,s,Order,\"+1.0 (−1.0 … +3.0), not told apart\",1\r\n"),
            std::string::npos);
  const std::string html = to_html(table);
  EXPECT_NE(
      html.find("<th scope=\"row\">s</th><td class=\"number saves\" data-value=\"3\">+3.0 "
                "<span class=\"interval\">(+2.0 … +4.0)</span> <span class=\"verdict\">saves</span></td>"),
      std::string::npos)
      << html;
  EXPECT_NE(html.find("class=\"number open\""), std::string::npos);
  EXPECT_NE(
      html.find(
          "<td class=\"number costs\" data-value=\"-3\">−3.0 <span class=\"verdict\">costs</span></td>"),
      std::string::npos);
  EXPECT_EQ(to_text(table),
            "T\n"
            "Scenario                               Order\n"
            "s                  +3.0 (+2.0 … +4.0), saves\n"
            "s         +1.0 (−1.0 … +3.0), not told apart\n"
            "s                                −3.0, costs\n");
}

TEST(Tables, StateTheErrorOfPredictions) {
  StudyResults results = sample_results();
  // element force: 1 ms were measured in the scrambled order, 0.5, 0.25, 0.2 and 1.1 ms in the others; twice
  // as much was predicted
  const auto predict = [&](std::size_t order, double ms) {
    results.meshes[0].orders[order].kernels[1].predicted_ms = ms;
  };
  predict(0, 0.8);   // 2.5 times as fast as scrambled; measured: 2 times: +25 %
  predict(1, 1);     // 2 times; measured: 4 times: −50 %
  predict(2, 0.4);   // 5 times; measured: 5 times
  predict(4, 1.98);  // 1/0.99; measured: 1/1.1: +11.1 %, and of the wrong sign
  const auto tables = tables_of(results);
  const auto value = [&](const char* column) {
    return *cell(tables, "prediction-error", "element force", column).value;
  };
  EXPECT_EQ(value("Speedups"), 4);
  EXPECT_NEAR(value("Median error, %"), (11.1111 + 25) / 2, 1e-3);
  EXPECT_NEAR(value("90 % within, %"), 50, 1e-9);
  EXPECT_NEAR(value("Largest, %"), 50, 1e-9);
  // the times differ by more than 10 % in nine of the ten pairs, all except scrambled and VF scrambled. One
  // of the nine is predicted wrong: original (0.5, predicted 0.8) and Fiedler (0.25, predicted 1)
  EXPECT_EQ(value("Of pairs"), 9);
  EXPECT_EQ(value("Right"), 8);
  EXPECT_EQ(cell(tables, "kernels", "dragon, element force, Original", "Error, %").text, "+25.0");
  EXPECT_EQ(cell(tables, "kernels", "dragon, element force, Fiedler", "Error, %").text, "−50.0");
  EXPECT_EQ(cell(tables, "kernels", "dragon, element force, Scrambled", "Error, %").text, "–");
  EXPECT_EQ(cell(tables, "prediction-error", "SpMV", "Largest, %").value, 0);
}

TEST(Tables, LeaveOutWhatTheResultsDoNotHold) {
  EXPECT_TRUE(tables_of({}).empty());
  StudyResults results = sample_results();
  EXPECT_EQ(ids(tables_of(results)),
            (std::vector<std::string>{"summary", "table-1", "table-2", "table-3", "table-4", "break-even",
                                      "phases", "motions", "misses-1", "misses-2", "prediction-error",
                                      "kernels", "machine", "protocol"}));
  // a study with meshes only
  results.scenarios.clear();
  EXPECT_EQ(ids(tables_of(results)),
            (std::vector<std::string>{"table-1", "misses-1", "misses-2", "prediction-error", "kernels",
                                      "machine", "protocol"}));
  // the reference has not run
  results = sample_results();
  for (ScenarioRecord& scenario : results.scenarios) scenario.orders[3].runs.clear();
  const auto tables = tables_of(results);
  EXPECT_EQ(find_table(tables, "table-2")->rows.size(), 8);
  EXPECT_EQ(find_table(tables, "summary"), nullptr);
  EXPECT_EQ(find_table(tables, "table-3"), nullptr);
  EXPECT_EQ(find_table(tables, "table-4"), nullptr);
}

TEST(Tables, TakeMoreOrdersThanThePapers) {
  StudyResults results = sample_results();
  results.orderings.push_back({"hilbert", "", "hilbert", "lexmax"});
  for (ScenarioRecord& scenario : results.scenarios) {
    scenario.orders.push_back(scenario.orders[1]);
    scenario.orders.back().ordering = "hilbert";
  }
  results.meshes[0].orders.push_back(results.meshes[0].orders[1]);
  results.meshes[0].orders.back().ordering = "hilbert";
  const auto tables = tables_of(results);
  EXPECT_EQ(cell(tables, "table-4", "falling, hilbert", "Speedup, %").text, "+25.0");
  EXPECT_EQ(cell(tables, "table-4", "falling, hilbert", "Paper, %").text, "–");
  EXPECT_EQ(cell(tables, "summary", "falling", "hilbert").text, "+25.0");
  EXPECT_EQ(cell(tables, "kernels", "dragon, SpMV, hilbert", "Measured").text, "4.00×");
}

TEST(Tables, HeadEveryRowOfATableDifferently) {
  for (const Table& table : tables_of(sample_results())) {
    std::vector<std::string> heads;
    for (const auto& row : table.rows) {
      heads.push_back(row.front().text);
      EXPECT_EQ(row.size(), table.columns.size()) << table.id;
    }
    std::sort(heads.begin(), heads.end());
    EXPECT_EQ(std::adjacent_find(heads.begin(), heads.end()), heads.end()) << table.id;
  }
}

}  // namespace
