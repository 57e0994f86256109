// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

namespace meshorder::command {

/// Merges notes that differ only in their first quoted name, at the place of the
/// first: "the set 'a' of vertices is not written (likewise 'b', 'c' and 15 more)".
Notes grouped_by_name(const Notes& notes);

}  // namespace meshorder::command
