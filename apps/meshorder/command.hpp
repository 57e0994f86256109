// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"

#include <CLI/CLI.hpp>

#include <functional>
#include <stdexcept>
#include <string>

namespace meshorder::command {

/// What every subcommand understands.
struct Common {
  bool json = false;
  bool quiet = false;
  int threads = 0;  ///< 0: as many as the machine has
};

/// Ends the command with a sentence and an exit status of its own.
struct Stopped : std::runtime_error {
  Stopped(const std::string& sentence, int exit_status) : std::runtime_error(sentence), status(exit_status) {}
  int status;
};

/// An order as users name it.
struct OrderNames {
  std::string vertices;
  std::string elements;
};

/// VERTICES or VERTICES/ELEMENTS; elements follow lexmax where only vertices are named, and stay or are
/// scrambled when vertices do or are.
OrderNames order_named(const std::string& name);

/// A subcommand adds itself to the application; its work runs after the arguments are understood.
void add_order(CLI::App& app);
void add_apply(CLI::App& app);
void add_info(CLI::App& app);
void add_compare(CLI::App& app);
void add_models(CLI::App& app);
void add_methods(CLI::App& app);
void add_simulate(CLI::App& app);
void add_reproduce(CLI::App& app);
void add_serve_steps(CLI::App& app);
void add_report(CLI::App& app);

/// --json, --quiet and --threads.
void add_common(CLI::App& subcommand, Common& common);

/// --for, --seed and --tolerance.
void add_ordering_options(CLI::App& subcommand, OrderingOptions& options);

/// Runs `work`, and what comes after it in this process, with at most `threads` threads (0: all).
void with_threads(int threads, const std::function<void()>& work);

}  // namespace meshorder::command
