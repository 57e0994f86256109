// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
}  // namespace CLI

namespace meshorder::command {

/// What a program with subcommands adds to `run_program`.
struct Program {
  /// Gives the parser its options and subcommands. May remove arguments that are not for the parser.
  void (*describe)(CLI::App& app, std::vector<std::string>& arguments);
  /// Executes another program if that does the work. Returns the exit status if this fails, else nothing.
  std::optional<int> (*hand_over)(char** arguments) noexcept = nullptr;
};

/// Prepares memory, standard streams and libraries for the work of a process. Call it first.
void prepare_process();

/// Implements the `main` of `program`: prepares the process, parses the arguments, runs the subcommand and
/// reports failures.
///
/// @return exit status: 0, 2 for bad input, 1 for a failure of the program
int run_program(const Program& program, int argc, char** argv) noexcept;

/// Returns whether `mpirun` or `srun` started this process, according to environment variables.
bool is_started_as_rank();

/// Returns whether `mpirun` or `srun` started this process together with others, according to environment
/// variables. Variables that only describe a batch script do not count.
bool is_one_of_several();

/// Returns whether this process is the first of those started together, or the only one.
bool is_first_process();

}  // namespace meshorder::command
