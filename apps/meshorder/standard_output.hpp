// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder::command {

/// Writes text to stdout. Throws CommandError if it cannot be written; where the reader of a pipe has gone
/// away, the text is dropped instead.
void write_stdout(std::string_view text);

/// Writes what is buffered; throws likewise.
void flush_stdout();

}  // namespace meshorder::command
