// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// Another process with which this one exchanges lines of text: what the child reads on its standard input
/// and writes to its standard output. Ctrl-C does not reach it; it ends with this process at the latest.
class ChildProcess {
 public:
  /// With `fixed_addresses` the system puts the program, its heap and its mappings where it puts them in
  /// every such process, where it allows that. Throws Error when the program cannot be started.
  ChildProcess(std::filesystem::path program, const std::vector<std::string>& arguments,
               bool fixed_addresses = false);
  /// Ends the child.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess(ChildProcess&&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ChildProcess& operator=(ChildProcess&&) = delete;

  /// Throws Error when the child has ended.
  void send(std::string_view line);

  /// The child's next line, without its end; waits for it. Throws Error, which tells how the child ended,
  /// when there is none.
  std::string receive();

 private:
  [[noreturn]] void throw_ended();

  std::filesystem::path program_;
  pid_t id_ = -1;
  int socket_ = -1;
  std::FILE* replies_ = nullptr;
};

/// Whether this process was started with fixed addresses.
bool has_fixed_addresses();

}  // namespace meshorder
