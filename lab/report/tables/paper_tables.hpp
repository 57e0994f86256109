// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

namespace meshorder {

// The paper's tables with its numbers next to ours, a row for each mesh or scenario and order. A table
// without data has no rows. The paper's column is omitted in a study without its scenarios or with another
// reference.

Table edge_span_table(const StudyResults& results);   ///< Table 1
Table seconds_table(const StudyResults& results);     ///< Table 2
Table saved_table(const StudyResults& results);       ///< Table 3
Table speedup_table(const StudyResults& results);     ///< Table 4
Table break_even_table(const StudyResults& results);  ///< what the orders cost, and when they pay off

}  // namespace meshorder
