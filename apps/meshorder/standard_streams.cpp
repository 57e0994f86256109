// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "standard_streams.hpp"

#include "base/text.hpp"
#include "command.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <new>
#include <string>

namespace meshorder::command {
namespace {

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): state of the process, as stderr
std::atomic<std::FILE*> messages = nullptr;  // null: stderr
volatile std::sig_atomic_t descriptor_of_messages = STDERR_FILENO;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void refuse_unless_reader_left() {
  if (errno != EPIPE)
    throw CommandError("standard output: cannot be written to the end; is the disk full?", kBadInput);
}

}  // namespace

void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // `open` returns the lowest free number, which is the number of the closed stream
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

void write_stderr(std::string_view text) noexcept {
  std::FILE* const stream = messages;
  (void)std::fwrite(text.data(), 1, text.size(), stream != nullptr ? stream : stderr);
}

void silence_libraries() noexcept {
#ifdef MESHORDER_IS_SANITIZED
  return;  // sanitizers report on stderr
#endif
  constexpr int kBeyondThoseOfShells = 10;
  static const int copy = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, kBeyondThoseOfShells);
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): writing changes a stream
  static std::FILE* const stream = copy < 0 ? nullptr : ::fdopen(copy, "w");
  if (stream == nullptr) return;
  (void)std::setvbuf(stream, nullptr, _IONBF, 0);
  const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nothing < 0) return;
  messages = stream;
  descriptor_of_messages = copy;
  (void)::dup2(nothing, STDERR_FILENO);
  (void)::close(nothing);
}

void hear_libraries() noexcept {
  if (messages.exchange(nullptr) == nullptr) return;
  (void)::dup2(descriptor_of_messages, STDERR_FILENO);
  descriptor_of_messages = STDERR_FILENO;
}

int messages_descriptor() noexcept { return descriptor_of_messages; }

int report_failure(std::string_view message, int status) noexcept {
  std::string escaped;
  try {
    escaped = visible(message);
    message = escaped;
  } catch (const std::bad_alloc&) {
    // print the message unescaped
  }
  for (const std::string_view part : {std::string_view("meshorder: "), message, std::string_view("\n")})
    write_stderr(part);
  return status;
}

}  // namespace meshorder::command
