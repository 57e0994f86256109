// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshorder::command {

// exit statuses of a failure
inline constexpr int kOwnFailure = 1;  ///< of the program
inline constexpr int kBadInput = 2;    ///< of the arguments or files

/// Gives closed standard streams a descriptor that refuses reading or writing, so that no file that is opened
/// later takes their place. Call it first.
void occupy_closed_streams();

/// Writes text to stdout. Throws CommandError if this fails; if the reader of a pipe has closed it, drops the
/// text instead.
void write_stdout(std::string_view text);

/// Writes the buffered text. Throws as `write_stdout` does.
void flush_stdout();

/// Writes text to stderr; ignores a failure, which could not be reported.
void write_stderr(std::string_view text) noexcept;

/// Drops what libraries print on stderr, including messages of the C library before it aborts. Messages that
/// this program writes by `write_stderr` or to `messages_descriptor` still appear.
void silence_libraries() noexcept;
/// Ends the effect of `silence_libraries`.
void hear_libraries() noexcept;
/// Returns the descriptor for messages of this program; a signal handler may call it.
int messages_descriptor() noexcept;

/// Prints why the command failed and returns the status. Characters that a terminal acts on are escaped,
/// unless memory has run out.
int report_failure(std::string_view message, int status) noexcept;

}  // namespace meshorder::command
