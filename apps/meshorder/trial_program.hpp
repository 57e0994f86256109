// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "restrictions.hpp"

#include <sys/types.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace meshorder::command {

/// Exception: a signal that ends meshorder came while a program ran; the program has been ended.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// While this object exists, the signals that end a process are blocked, except those of its own faults
/// (SIGSEGV and others) and SIGKILL. `run_program` and `run_in_child` notice them, throw Interrupted and
/// leave them pending; they take effect when the object is destroyed. On Linux, descendants that lose their
/// parent become children of this process, for good.
class TrialSignals {
 public:
  TrialSignals();
  ~TrialSignals();
  TrialSignals(const TrialSignals&) = delete;
  TrialSignals(TrialSignals&&) = delete;
  TrialSignals& operator=(const TrialSignals&) = delete;
  TrialSignals& operator=(TrialSignals&&) = delete;

 private:
  sigset_t before_{};
};

/// A program with its arguments and limits.
struct TrialCommand {
  std::vector<std::string> words;     ///< the first word as `find_program` returns it
  std::filesystem::path folder;       ///< its current directory
  std::filesystem::path log;          ///< prefix of the files that receive what it prints: log.out, log.err
  double timeout_seconds = 0;         ///< elapsed time; 0: no limit
  std::filesystem::path temporary{};  ///< its TMPDIR; empty: that of this process
  const WriteProtection* protection = nullptr;  ///< if not null, enforced on it
};

/// Result of a run.
struct TrialRun {
  double wall_seconds = 0;
  double processor_seconds = 0;  ///< user and system time of the program and its descendants
  std::int64_t peak_bytes = 0;   ///< largest memory of one of these processes
  int exit_status = 0;           ///< −1 if a signal ended it
  int signal = 0;                ///< signal that ended it; 0: none
  bool timed_out = false;
  int left_behind = 0;  ///< processes that still ran when the program ended, and were killed

  [[nodiscard]] bool succeeded() const { return exit_status == 0 && !timed_out; }
};

/// Returns the absolute path of a program, found as a shell does: a name with a slash is a path, other names
/// are looked up in PATH. Throws InvalidArgument if there is no such program or it cannot be executed.
std::string find_program(const std::string& name);

/// Runs a program in a process group of its own, without a shell and with an empty standard input. Waits for
/// the program and kills the processes that it left running. Throws InvalidArgument if the program cannot be
/// executed, Unavailable if no process can be started, Interrupted at a signal.
TrialRun run_program(const TrialCommand& command);

/// Calls `work` in a child process, for work that may not end or may crash. Throws Unavailable and
/// Interrupted as `run_program`; the child ends without a status if `work` throws.
TrialRun run_in_child(const std::function<void()>& work, double timeout_seconds);

/// Returns why a run failed: "exit status 3: *ERROR in readinput …". The line is the last that reports an
/// error, else the last on stderr, else the last on stdout.
std::string failure_of(const TrialRun& run, const TrialCommand& command);

}  // namespace meshorder::command
