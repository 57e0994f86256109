// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <string>
#include <vector>

namespace meshorder {

/// Returns what the results show, in a few sentences for the top of the page and of tables.md: where an order
/// saves time and how much, where the difference is within the noise, where it loses time, and how that
/// compares with the paper. Made from the numbers alone.
std::vector<std::string> findings_of(const StudyResults& results);

}  // namespace meshorder
