// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

namespace meshorder::command {

/// Merges notes that differ only in their first quoted name: "the set 'a' of vertices is not written
/// (likewise 'b', 'c' and 15 more)". The merged note takes the position of the first of them.
Notes grouped_by_name(const Notes& notes);

}  // namespace meshorder::command
