// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace meshorder::command {

/// A signal that ends meshorder came while a program ran, which is ended by now.
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

/// While alive, signals that end meshorder (SIGINT, SIGTERM, SIGHUP) wait: `run_program` notices them, throws
/// Interrupted and leaves them pending, so that they take effect once this object is gone and everything that
/// was made after it is removed. Processes that lose their parent become children of this one (Linux).
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

/// A program with its arguments and what it may take.
struct TrialCommand {
  std::vector<std::string> words;  ///< the first one as `find_program` returns it
  std::filesystem::path folder;    ///< its current directory
  std::filesystem::path log;       ///< prefix of the files that get what it prints: log.out, log.err
  double timeout_seconds = 0;      ///< by the clock; 0: no end
};

/// How a run went.
struct TrialRun {
  double wall_seconds = 0;
  double processor_seconds = 0;  ///< user and system time of the program and of all that it started
  std::int64_t peak_bytes = 0;   ///< memory of the largest of these processes
  int exit_status = 0;           ///< −1 if a signal ended it
  int signal = 0;                ///< that ended it, 0 if none did
  bool timed_out = false;
  int left_behind = 0;  ///< processes that were still running when the program ended, and were ended then

  [[nodiscard]] bool succeeded() const { return exit_status == 0 && !timed_out; }
};

/// Returns the absolute path of a program, as a shell finds it: a name with a slash is a path, others are
/// looked for in PATH. Throws InvalidArgument if there is none or it cannot be executed.
std::string find_program(const std::string& name);

/// Runs a program, without a shell and with an empty standard input, in a process group of its own, and waits
/// for it. What it started and left running is ended. Throws InvalidArgument if it cannot be executed, and
/// Interrupted.
TrialRun run_program(const TrialCommand& command);

/// Returns why a run did not succeed: "exit status 3: the last line that it printed on stderr".
std::string failure_of(const TrialRun& run, const TrialCommand& command);

}  // namespace meshorder::command
