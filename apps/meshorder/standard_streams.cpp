// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "standard_streams.hpp"

#include "base/text.hpp"
#include "command.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <new>
#include <string>

namespace meshorder::command {
namespace {

void refuse_unless_reader_left() {
  constexpr int kBadInput = 2;
  if (errno != EPIPE)
    throw CommandError("standard output: cannot be written to the end; is the disk full?", kBadInput);
}

}  // namespace

void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // takes the lowest number that is free
    (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void write_stdout(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size()) refuse_unless_reader_left();
}

void flush_stdout() {
  errno = 0;
  if (std::fflush(stdout) != 0) refuse_unless_reader_left();
}

void write_stderr(std::string_view text) noexcept { (void)std::fwrite(text.data(), 1, text.size(), stderr); }

int report_failure(std::string_view message, int status) noexcept {
  std::string escaped;
  try {
    escaped = visible(message);
    message = escaped;
  } catch (const std::bad_alloc&) {
    // as it is
  }
  for (const std::string_view part : {std::string_view("meshorder: "), message, std::string_view("\n")})
    write_stderr(part);
  return status;
}

}  // namespace meshorder::command
