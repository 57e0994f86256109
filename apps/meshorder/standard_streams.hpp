// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder::command {

/// Gives standard streams that are closed a descriptor that refuses writing, so that no file that is opened
/// later takes their place. To be called first.
void occupy_closed_streams();

/// Writes text to stdout. Throws CommandError if it cannot be written; where the reader of a pipe has gone
/// away, the text is dropped instead.
void write_stdout(std::string_view text);

/// Writes what is buffered; throws likewise.
void flush_stdout();

/// Writes text to stderr; ignores a failure, which could not be reported.
void write_stderr(std::string_view text) noexcept;

/// Has what libraries print on stderr dropped, also what the C library says before it aborts. What this
/// program prints, by `write_stderr` and to `messages_descriptor`, is still seen.
void silence_libraries() noexcept;
/// Ends that.
void hear_libraries() noexcept;
/// Returns the descriptor that messages of this program go to; for a signal handler, too.
int messages_descriptor() noexcept;

/// Prints why the command fails, with characters that a terminal acts on escaped as long as there is memory,
/// and returns the status.
int report_failure(std::string_view message, int status) noexcept;

}  // namespace meshorder::command
