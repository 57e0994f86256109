// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

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

/// The paper's tables with its figures beside ours, and those that go with them. Their ids:
/// - table-1: edge spans, by mesh and order
/// - table-2: seconds, by scenario and order, as the following
/// - table-3: seconds saved over the reference
/// - table-4: speedups in per cent with their intervals
/// - break-even: what an order costs and the step at which that is paid
/// - phases: seconds of the parts of a step
/// - motions: how far the motion in an order is from that in the first
/// - misses-1, misses-2, …: simulated misses, one table for each cache hierarchy
/// - kernels: predicted and measured speedups of the kernels, by mesh, kernel and order
/// - machine, protocol: what it was measured on, and how
/// In this order; those for which the results hold nothing are left out. A cell's value is the number in the
/// results, or what follows from numbers there; its text is rounded.
std::vector<Table> tables_of(const StudyResults& results);

/// All of them, one after another.
std::string to_markdown(const std::vector<Table>& tables);
/// One row for each cell: table,row,column,text,value. (RFC 4180)
std::string to_csv(const std::vector<Table>& tables);
/// A table element with data-value attributes; text is escaped.
std::string to_html(const Table& table);

}  // namespace meshorder
