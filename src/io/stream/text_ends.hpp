// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "io/stream/scanner.hpp"

#include <string>
#include <string_view>

namespace meshorder {

/// What comes before and after the data of a text file, so that a writer can put it back.

/// The lines up to the last comment that comes before the first word, as they are; empty without one.
std::string comments_before(std::string_view text, char comment);

/// The lines from the first comment on that stands after the last line with a word, as they are.
std::string comments_after(std::string_view text, char comment);

/// Notes a file whose last line has no end: its last number may have been cut short, which nobody can see.
void note_missing_line_end(const Scanner& scanner, char comment, Notes& notes);

}  // namespace meshorder
