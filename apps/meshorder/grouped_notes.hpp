// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

namespace meshorder::command {

/// Returns the notes, with those that differ in their first quoted name only as one, in the place of the
/// first: "the set 'a' of vertices is not written (likewise 'b', 'c' and 15 more)".
Notes grouped_by_name(const Notes& notes);

}  // namespace meshorder::command
