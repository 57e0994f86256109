// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

#include <vector>

namespace meshorder {

// Tables that explain the paper's. A table without data has no rows.

Table phases_table(const StudyResults& results);
Table motions_table(const StudyResults& results);
/// Returns a table for each cache hierarchy, in the sequence of the meshes.
std::vector<Table> misses_tables(const StudyResults& results);
/// Returns how far the predicted speedups of the kernels are from the measured ones.
Table prediction_table(const StudyResults& results);
Table kernels_table(const StudyResults& results);
Table machine_table(const StudyResults& results);
Table protocol_table(const StudyResults& results);

}  // namespace meshorder
