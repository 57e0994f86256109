// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// Returns what the results show beyond the table of what the orders save, in a few sentences to stand below
/// it: how far the study goes, when orders pay off, whether all did the same work, and what spans, simulated
/// caches and predictions say. Made from the numbers alone.
std::vector<std::string> findings_of(const StudyResults& results);

}  // namespace meshorder
