// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

namespace meshorder {

// The paper's tables with its figures beside ours, a row for each mesh or scenario and order. Without rows
// where the results hold nothing. The paper's column is left out where it could not say anything: in a study
// without its scenarios, or of another reference.

Table edge_span_table(const StudyResults& results);   ///< Table 1
Table seconds_table(const StudyResults& results);     ///< Table 2
Table saved_table(const StudyResults& results);       ///< Table 3
Table speedup_table(const StudyResults& results);     ///< Table 4
Table break_even_table(const StudyResults& results);  ///< what the orders cost, and when that is paid

}  // namespace meshorder
