// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace meshorder::command {

/// What every subcommand understands.
struct Common {
  bool json = false;
  bool quiet = false;
  int threads = 0;  ///< 0: as many as the machine has
};

/// A subcommand adds itself to the application; its work runs after the arguments are understood.
void add_order(CLI::App& app);
void add_apply(CLI::App& app);
void add_info(CLI::App& app);
void add_compare(CLI::App& app);
void add_models(CLI::App& app);
void add_methods(CLI::App& app);

/// --json, --quiet and --threads.
void add_common(CLI::App& subcommand, Common& common);

/// --seed and --tolerance, into OrderingOptions.
template <class Options>
void add_ordering_options(CLI::App& subcommand, Options& options) {
  subcommand.add_option("--seed", options.seed, "Seed of random orders, METIS and start vectors")
      ->capture_default_str();
  subcommand
      .add_option("--tolerance", options.tolerance,
                  "Residual of Fiedler vectors, relative to lambda2; the order settles at 0.1")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

/// Runs `work` with at most `threads` threads (0: all).
void with_threads(int threads, const std::function<void()>& work);

}  // namespace meshorder::command
