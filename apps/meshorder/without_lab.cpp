// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// What stands for the laboratory's subcommands in a command that is built without it, as that of the Python
// package.
#include "command.hpp"

#include <CLI/CLI.hpp>

namespace meshorder::command {
namespace {

/// Takes all that follows the subcommand's name, and ends with a message.
void refuse(CLI::App& subcommand) {
  subcommand.group("");  // not shown in the help
  subcommand.set_help_flag();
  subcommand.fallthrough(false);
  subcommand.prefix_command();
  subcommand.callback([&subcommand] {
    constexpr int kBadInput = 2;
    throw CommandError(
        subcommand.get_name() + " is in the full build only, which ./run makes from the sources", kBadInput);
  });
}

}  // namespace

void add_models(CLI::App& subcommand) { refuse(subcommand); }
void add_simulate(CLI::App& subcommand) { refuse(subcommand); }
void add_reproduce(CLI::App& subcommand) { refuse(subcommand); }
void add_serve_steps(CLI::App& subcommand) { refuse(subcommand); }
void add_report(CLI::App& subcommand) { refuse(subcommand); }

}  // namespace meshorder::command
