// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <vector>

namespace meshorder {

/// Sorts every row of compressed sparse rows, drops repeats and, unless `keeps_loops`, loops, and closes the
/// gaps. O(entries · log row length).
///
/// @param starts  rows + 1
void tidy_rows(std::vector<Offset>& starts, std::vector<Index>& columns, bool keeps_loops);

}  // namespace meshorder
