// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "standard_output.hpp"

#include "command.hpp"

#include <cerrno>
#include <cstdio>

namespace meshorder::command {
namespace {

void refuse_unless_reader_left() {
  constexpr int kBadInput = 2;
  if (errno != EPIPE)
    throw CommandError("standard output: cannot be written to the end; is the disk full?", kBadInput);
}

}  // namespace

void write_stdout(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) < text.size()) refuse_unless_reader_left();
}

void flush_stdout() {
  errno = 0;
  if (std::fflush(stdout) != 0) refuse_unless_reader_left();
}

}  // namespace meshorder::command
