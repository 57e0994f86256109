// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include "payoff/machine_choice.hpp"
#include "progress.hpp"
#include <meshorder/io.hpp>
#include <meshorder/payoff.hpp>

#include <string>

namespace meshorder::command {

/// Adds --machine, whose value choose_machine reads.
void add_machine_option(CLI::App& subcommand, std::string& machine);

/// Adds --all-threads, likewise.
void add_all_threads_option(CLI::App& subcommand, bool& all_threads);

/// Adds --kernels, plain or tuned.
void add_kernels_option(CLI::App& subcommand, KernelSet& kernels);

/// Returns the machine to predict for. If the choice only replaces this machine, which is not calibrated,
/// this machine is calibrated and the result is kept for the next time. A line on stderr says so, unless
/// quiet; `notes` receives a sentence where something went wrong.
MachineChoice calibrated(MachineChoice choice, bool all_threads, Progress& progress, bool quiet,
                         Notes& notes);

}  // namespace meshorder::command
