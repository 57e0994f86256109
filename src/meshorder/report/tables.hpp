// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/study/results.hpp>

#include <optional>
#include <string>
#include <vector>

namespace meshorder {

/// A cell of a table: what is shown, and the number behind it, by which a column is sorted.
struct TableCell {
  std::string text;
  std::optional<double> value;
  bool weak = false;  ///< swallowed by the noise, or unknown: shown paler, and in words
};

/// A table as Markdown, CSV and the page show it.
struct Table {
  std::string id;       ///< "table-1", unique
  std::string title;    ///< "Table 1: mean edge span"
  std::string caption;  ///< what is measured, in a sentence or two
  std::vector<std::string> columns;
  std::vector<std::vector<TableCell>> rows;  ///< the first cell heads the row
};

/// The paper's tables with its figures beside ours, and those that go with them:
/// table-1 edge spans, table-2 seconds, table-3 seconds saved, table-4 speedups in per cent with intervals
/// and break-even steps, then simulated misses, phases of a step, predicted against measured kernels, motions
/// compared, the machine. Those for which the results hold nothing are left out.
std::vector<Table> tables_of(const StudyResults& results);

/// What the results say, in a few sentences for the top of the page and of tables.md: where the order pays and
/// how much, where the noise swallows it, where it loses, how that compares with the paper. Made from the
/// numbers alone.
std::vector<std::string> findings_of(const StudyResults& results);

/// All of them, one after another.
std::string to_markdown(const std::vector<Table>& tables);
/// One row for each cell: table,row,column,text,value. (RFC 4180)
std::string to_csv(const std::vector<Table>& tables);
/// A table element with data-value attributes; text is escaped.
std::string to_html(const Table& table);

}  // namespace meshorder
