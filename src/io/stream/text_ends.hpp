// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"
#include "io/stream/scanner.hpp"

#include <string>
#include <string_view>

namespace meshorder {

// Text before and after the data of a text file.

/// Returns a text without the byte order mark of UTF-8 that some editors put before it.
std::string_view without_byte_order_mark(std::string_view text);

/// Returns a text without the zero bytes and the Ctrl-Z that some programs put after it, and without blanks
/// and line ends between and after these. Returns other bytes unchanged if a zero byte precedes them: they
/// are binary.
std::string_view without_padding(std::string_view text);

/// Returns whether a text has nothing but zero bytes, Ctrl-Z, blanks and line ends.
bool is_padding(std::string_view text);

// Comments are kept for the writer.

/// Returns verbatim all lines up to the last comment before the data; empty if no comment precedes the data.
std::string comments_before(std::string_view text, char comment);

/// Returns the comments at the end of a text, verbatim: all lines from the first comment after the data.
std::string comments_after(std::string_view text, char comment);

/// Adds a note if the last line has no newline and no comment: its last number may be truncated.
void note_missing_line_end(const Scanner& scanner, char comment, Notes& notes);

}  // namespace meshorder
