// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// Returns what the results show beyond the table of savings, in a few sentences to print below it: limits of
/// the study, when orders pay off, whether all orders did the same work, and what spans, simulated caches and
/// predictions show. Made from the numbers alone.
std::vector<std::string> findings_of(const StudyResults& results);

}  // namespace meshorder
