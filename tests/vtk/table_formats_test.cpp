// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/tables/tables.hpp"
#include "support/sample_results.hpp"

#include <gtest/gtest.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace {

using namespace meshorder;

/// A possible file name.
constexpr const char* kHostile = "a|b,\"c\"\n<i>d</i>&amp;\\|`e`*_[f](g)'#~";

StudyResults hostile_results() {
  StudyResults results = test::sample_results();
  results.meshes[0].name = kHostile;
  for (ScenarioRecord& scenario : results.scenarios) scenario.mesh = kHostile;
  return results;
}

/// The fields of a CSV file, read by RFC 4180.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> records{{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& field = records.back().back();
    if (quoted) {
      if (text[i] != '"') {
        field += text[i];
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        field += text[++i];
      } else {
        quoted = false;
      }
    } else if (text[i] == '"') {
      EXPECT_TRUE(field.empty());
      quoted = true;
    } else if (text[i] == ',') {
      records.back().emplace_back();
    } else if (text.compare(i, 2, "\r\n") == 0) {
      records.push_back({""});
      ++i;
    } else {
      field += text[i];
    }
  }
  records.pop_back();
  return records;
}

TEST(TableFormats, CsvHoldsEveryCellAndItsNumberToTheLastBit) {
  const auto tables = tables_of(hostile_results());
  const auto records = parse_csv(to_csv(tables));
  EXPECT_EQ(records.front(), (std::vector<std::string>{"table", "row", "column", "text", "value"}));
  std::size_t r = 1;
  for (const Table& table : tables) {
    for (const auto& row : table.rows) {
      for (std::size_t c = 1; c < row.size(); ++c, ++r) {
        ASSERT_LT(r, records.size());
        ASSERT_EQ(records[r].size(), 5);
        EXPECT_EQ(records[r][0], table.id);
        EXPECT_EQ(records[r][1], row[0].text);
        EXPECT_EQ(records[r][2], table.columns[c]);
        EXPECT_TRUE(records[r][3].starts_with(row[c].text))
            << records[r][3];  // interval and certainty follow
        EXPECT_NE(records[r][3].find(row[c].interval), std::string::npos) << records[r][3];
        EXPECT_EQ(records[r][4].empty(), !row[c].value);
        if (row[c].value) {
          EXPECT_EQ(std::strtod(records[r][4].c_str(), nullptr), *row[c].value);
        }
      }
    }
  }
  EXPECT_EQ(r, records.size());
}

/// The cells of a line of a Markdown table, without the backslashes.
std::vector<std::string> markdown_cells(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '|') {
      cells.emplace_back();
    } else if (cells.empty()) {
      ADD_FAILURE() << line;
      return cells;
    } else {
      if (line[i] == '\\') ++i;
      cells.back() += line[i];
    }
  }
  cells.pop_back();
  for (std::string& cell : cells) cell = cell.substr(1, cell.size() - 2);
  return cells;
}

TEST(TableFormats, MarkdownKeepsHostileNamesInTheirCells) {
  const Table table{"id", "T|<b>", "C_1_", {"Head", "Number"}, {{{kHostile, {}, false}, {"1", 1.0, false}}}};
  const std::string text = to_markdown({table, table});
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  ASSERT_EQ(lines.size(), 2 * 7 + 1);
  EXPECT_EQ(lines[0], "## T\\|\\<b\\>");
  EXPECT_EQ(lines[2], "C\\_1\\_");
  EXPECT_EQ(lines[4], "| Head | Number |");
  EXPECT_EQ(lines[5], "| --- | ---: |");
  std::string expected = kHostile;
  expected[expected.find('\n')] = ' ';
  EXPECT_EQ(markdown_cells(lines[6]), (std::vector<std::string>{expected, "1"}));
}

TEST(TableFormats, HtmlIsWellFormedAndShowsNamesAsTheyAre) {
  for (const Table& table : tables_of(hostile_results())) {
    const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
        vtkXMLUtilities::ReadElementFromString(to_html(table).c_str()));
    ASSERT_NE(root, nullptr) << table.id;
    EXPECT_STREQ(root->GetName(), "table");
    EXPECT_EQ(root->GetAttribute("id"), table.id);
    vtkXMLDataElement* const body = root->FindNestedElementWithName("tbody");
    ASSERT_EQ(body->GetNumberOfNestedElements(), table.rows.size());
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      vtkXMLDataElement* const row = body->GetNestedElement(static_cast<int>(r));
      ASSERT_EQ(row->GetNumberOfNestedElements(), table.columns.size());
      for (std::size_t c = 0; c < table.columns.size(); ++c) {
        vtkXMLDataElement* const shown = row->GetNestedElement(static_cast<int>(c));
        const TableCell& cell = table.rows[r][c];
        EXPECT_STREQ(shown->GetName(), c == 0 ? "th" : "td");
        std::string text = shown->GetCharacterData();
        if (shown->GetNumberOfNestedElements() > 0) text.erase(text.find_last_not_of(' ') + 1);
        EXPECT_EQ(text, cell.text) << table.id;
        if (!cell.interval.empty()) {
          EXPECT_EQ(shown->GetNestedElement(0)->GetCharacterData(), "(" + cell.interval + ")");
        }
        const char* const value = shown->GetAttribute("data-value");
        EXPECT_EQ(value != nullptr, cell.value.has_value());
        if (value != nullptr && cell.value) {
          EXPECT_EQ(std::strtod(value, nullptr), *cell.value);
        }
        const char* const classes = shown->GetAttribute("class");
        const bool pale = classes != nullptr && std::string(classes).find("weak") != std::string::npos;
        EXPECT_EQ(pale, cell.weak);
      }
    }
  }
}

}  // namespace
