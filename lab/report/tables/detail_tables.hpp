// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/tables/tables.hpp"

#include <vector>

namespace meshorder {

// What explains the paper's tables. Without rows where the results hold nothing.

Table phases_table(const StudyResults& results);
Table motions_table(const StudyResults& results);
/// One for each cache hierarchy, in the order in which the meshes name them.
std::vector<Table> misses_tables(const StudyResults& results);
Table kernels_table(const StudyResults& results);
Table machine_table(const StudyResults& results);
Table protocol_table(const StudyResults& results);

}  // namespace meshorder
