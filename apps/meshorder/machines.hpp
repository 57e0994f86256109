// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "command.hpp"
#include "payoff/machine_choice.hpp"
#include "progress.hpp"
#include <meshorder/io.hpp>
#include <meshorder/payoff.hpp>

#include <string>

namespace meshorder::command {

/// Adds --machine; choose_machine reads its value.
void add_machine_option(CLI::App& subcommand, std::string& machine);

/// Adds --all-threads; choose_machine reads it as well.
void add_all_threads_option(CLI::App& subcommand, bool& all_threads);

/// Adds --kernels, plain or tuned.
void add_kernels_option(CLI::App& subcommand, KernelSet& kernels);

/// Returns the machine to predict for. If `choice` stands in for this machine, calibrates this machine and
/// stores the result; if not `quiet`, first says so on stderr. Adds a sentence to `notes` if something goes
/// wrong.
MachineChoice calibrated(MachineChoice choice, bool all_threads, Progress& progress, bool quiet,
                         Notes& notes);

}  // namespace meshorder::command
