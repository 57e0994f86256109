// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// Returns the savings of the orders: a row for each scenario and a column for each order, with the paper's
/// numbers if it gives any.
Table summary_table(const StudyResults& results);

/// Returns "+11.9 (+10.2 … +13.5), saves" as a cell.
TableCell saving_cell(const Speedup& speedup);

/// Returns the per cent that an order saves in a scenario of the paper, "+27.8"; a dash if not given.
TableCell paper_cell(std::string_view scenario, std::string_view ordering);

// The paper's tables with its numbers next to ours, a row for each mesh or scenario and order. A table
// without data has no rows. The paper's column is omitted in a study without the paper's scenarios or with
// another reference.

/// Returns whether the paper has numbers for a scenario of the study, with the same reference.
bool has_paper(const StudyResults& results);
/// Returns how the study's runs differ from the paper's: " Not as in the paper: falling, 20 steps."
std::string differences_from_paper(const StudyResults& results);
/// Explanation, for captions, of a dash in the paper's column.
inline constexpr const char* kNotTold =
    " –: the paper's text gives no number; only the captions of its Figures 4 to 9 do.";

Table edge_span_table(const StudyResults& results);   ///< Table 1
Table seconds_table(const StudyResults& results);     ///< Table 2
Table saved_table(const StudyResults& results);       ///< Table 3
Table speedup_table(const StudyResults& results);     ///< Table 4
Table break_even_table(const StudyResults& results);  ///< what the orders cost, and when they pay off

// Further tables, which explain the paper's. A table without data has no rows.

Table phases_table(const StudyResults& results);
Table motions_table(const StudyResults& results);
/// Returns a table for each cache hierarchy, in the sequence of their first occurrence.
std::vector<Table> misses_tables(const StudyResults& results);
/// Returns how far the predicted speedups of the kernels are from the measured ones.
Table prediction_table(const StudyResults& results);
Table kernels_table(const StudyResults& results);
Table machine_table(const StudyResults& results);
Table protocol_table(const StudyResults& results);

}  // namespace meshorder
