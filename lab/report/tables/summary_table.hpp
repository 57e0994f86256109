// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

namespace meshorder {

/// Returns what the orders save, a row for each scenario and a column for each order, the paper's figures
/// beside them where it has some.
Table summary_table(const StudyResults& results);

/// Returns "+11.9 (+10.2 … +13.5), saves" as a cell.
TableCell saving_cell(const Speedup& speedup);

}  // namespace meshorder
