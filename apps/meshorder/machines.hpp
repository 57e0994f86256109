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

/// Returns the machine to predict for. If `choice` is only a substitute because this machine is not yet
/// calibrated, calibrates this machine and stores the result. Reports this on stderr unless `quiet`. `notes`
/// receives a sentence if something went wrong.
MachineChoice calibrated(MachineChoice choice, bool all_threads, Progress& progress, bool quiet,
                         Notes& notes);

}  // namespace meshorder::command
