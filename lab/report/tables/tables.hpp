// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Whether an order certainly saves or costs time, by the confidence interval of its saving.
enum class Certainty {
  unsaid,  ///< the cell shows something else
  saves,   ///< the interval lies above 0
  open,    ///< the interval contains 0, or there is no interval: not told apart
  costs    ///< the interval lies below 0
};

/// A cell of a table: its text, and the value by which a column is sorted.
struct TableCell {
  std::string text;
  std::optional<double> value;
  bool weak = false;                        ///< within the noise, or unknown: shown paler
  std::string interval = {};                ///< "+10.2 … +13.5", shown with the text
  Certainty certainty = Certainty::unsaid;  ///< shown in words, on the page in colour as well
};

/// A table as Markdown, CSV and the page show it.
struct Table {
  std::string id;       ///< "table-1", unique
  std::string title;    ///< "Table 1: mean edge span"
  std::string caption;  ///< what is measured, one or two sentences
  std::vector<std::string> columns;
  std::vector<std::vector<TableCell>> rows;  ///< the first cell is the row's head
};

/// Returns the paper's tables, with its numbers next to ours, and further tables. Their ids:
/// - summary: what the orders save, a row for each scenario and a column for each order
/// - table-1: edge spans, by mesh and order
/// - table-2: seconds, by scenario and order, as in the tables down to `motions`
/// - table-3: seconds saved over the reference
/// - table-4: speedups in per cent with their intervals
/// - break-even: what an order costs and the step at which it pays off
/// - phases: seconds of the parts of a step
/// - motions: largest distance between the motions in an order and in the first order
/// - misses-1, misses-2, …: simulated misses, one table for each cache hierarchy
/// - prediction-error: how far predicted speedups of the kernels are from measured ones, by kernel
/// - kernels: predicted and measured speedups of the kernels, by mesh, kernel and order
/// - machine, protocol: the machine, and how the study measured
/// Tables for which the results hold no data are omitted. A cell's value is a number of the results or is
/// derived from them; its text is rounded.
std::vector<Table> tables_of(const StudyResults& results);

std::string to_markdown(const std::vector<Table>& tables);
/// Returns the tables as CSV (RFC 4180), a line for each cell: table,row,column,text,value.
std::string to_csv(const std::vector<Table>& tables);
/// Returns text escaped for a line of Markdown, so that nothing in it is markup, or ends a table's cell or
/// line. Control characters are shown as escapes.
std::string markdown_escaped(std::string_view text);

/// Returns a table element with data-value attributes; text is escaped.
std::string to_html(const Table& table);

/// Returns the title, the columns aligned by blanks, and the caption, as lines for a terminal.
std::string to_text(const Table& table);

// Sentences of a report. Text in `backticks` is code; all other text is plain, so that no name in it acts as
// markup.

/// Returns text as HTML, with a no-break space before per cent signs.
std::string prose_as_html(std::string text);

/// Returns text as one paragraph of Markdown.
std::string prose_as_markdown(std::string_view text);

}  // namespace meshorder
