// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A child process that reads lines of text, or bytes, from its standard input and writes lines or bytes to
/// its standard output. The child ignores Ctrl-C, and ends no later than this process.
class ChildProcess {
 public:
  /// Starts a program. With `fixed_addresses`, address space randomisation is off where the system allows it:
  /// the program, its heap and its mappings lie at the same addresses in all such processes. Throws Error if
  /// the program cannot be started.
  ChildProcess(std::filesystem::path program, const std::vector<std::string>& arguments,
               bool fixed_addresses = false);
  /// Kills the child.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess(ChildProcess&&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ChildProcess& operator=(ChildProcess&&) = delete;

  /// Sends a line. Throws Error if the child has ended.
  void send(std::string_view line);

  /// Waits for the child's next line and returns it without its line break. Throws Error, which says how the
  /// child ended, if there is no further line.
  std::string receive();

  /// Sends bytes. Throws Error if the child has ended.
  void send_bytes(std::span<const std::byte> bytes);

  /// Waits until `bytes` is filled. Throws Error, which says how the child ended, if the child ends earlier.
  void receive_bytes(std::span<std::byte> bytes);

 private:
  [[noreturn]] void throw_ended();

  std::filesystem::path program_;
  pid_t id_ = -1;
  std::FILE* stream_ = nullptr;  // of a socket, which also takes what is sent
};

/// Returns whether address space randomisation is off.
bool has_fixed_addresses();

/// Returns the program of that name in the running program's folder, else on PATH; empty if there is no such
/// program.
std::filesystem::path find_program(std::string_view name);

/// How a process ended.
struct ExitStatus {
  int code = 0;           ///< its exit status, or 128 + the signal that killed it
  std::string last_line;  ///< the last line that it printed, to either stream; empty if it printed none
};

/// Runs a program in `folder` until it ends, without a shell and without input; its output goes to the file
/// `log`. Throws std::system_error if the program cannot be started.
ExitStatus run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder, const std::filesystem::path& log);

}  // namespace meshorder
