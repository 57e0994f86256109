// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "ordering/method.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
class Option;
class Validator;
}  // namespace CLI

namespace meshorder::command {

/// Options of every subcommand.
struct Common {
  bool json = false;
  bool quiet = false;
  int threads = 0;  ///< 0: as many threads as the machine has
};

/// Exception that ends the command with a message and an exit status.
struct CommandError : std::runtime_error {
  CommandError(const std::string& message, int exit_status)
      : std::runtime_error(message), status(exit_status) {}
  int status;
};

/// Returns the methods that VERTICES/ELEMENTS names. If only VERTICES is given, ELEMENTS is the same for
/// `auto`, `original` and `scrambled`, and lexmax for others.
MeshMethods order_named(const std::string& name);

// Each function adds the options of a subcommand, which runs once all arguments are parsed.
void add_order(CLI::App& subcommand);
void add_apply(CLI::App& subcommand);
void add_info(CLI::App& subcommand);
void add_compare(CLI::App& subcommand);
void add_try(CLI::App& subcommand);
void add_openfoam(CLI::App& subcommand);
void add_calibrate(CLI::App& subcommand);
void add_methods(CLI::App& subcommand);

/// Removes `--` and the words after it from the arguments of `try`, and stores these words as the program to
/// run.
void take_program_to_try(std::vector<std::string>& arguments);

/// Help of --quiet; the second text is for subcommands that only list something.
inline constexpr const char* kQuiet = "Print nothing but errors, and the object of --json";
inline constexpr const char* kQuietList = "No warnings; the list is still printed";

/// Adds --json, --quiet and --threads.
void add_common(CLI::App& subcommand, Common& common, const std::string& quiet = kQuiet);

/// Adds --limit-memory, --allow-includes-from and --trust. They apply to the rest of the process.
void add_reading_options(CLI::App& subcommand);

/// Adds --seed.
void add_seed_option(CLI::App& subcommand, std::uint64_t& seed);

/// Adds --for.
void add_workload_option(CLI::App& subcommand, OrderOptions& options);

/// Adds --for, --seed and --tolerance.
void add_ordering_options(CLI::App& subcommand, OrderOptions& options);

/// Adds --ids; parse<Ids> reads its value.
CLI::Option* add_ids_option(CLI::App& subcommand, std::string& ids);

/// Options that say which cells the output keeps, and whether it may lose data.
struct Keeping {
  int dimension = -1;   ///< of the cells to keep; −1 for all
  bool strict = false;  ///< refuse any loss
};

/// Adds --only and --strict.
void add_keeping_options(CLI::App& subcommand, Keeping& keeping);

/// Adds --cache; parse_caches reads its value.
void add_cache_option(CLI::App& subcommand, std::string& caches);

/// Accepts finite numbers above 0.
CLI::Validator positive();
/// Accepts whole numbers from `lowest` to `highest` (default: the largest int).
CLI::Validator whole_from(std::uint64_t lowest, std::uint64_t highest = std::numeric_limits<int>::max());
/// Accepts whole numbers from `lowest` to `highest`.
CLI::Validator in_range(int lowest, int highest);

/// Runs `work` with at most `threads` threads (0: all). The limit applies to the rest of the process.
void with_threads(int threads, const std::function<void()>& work);

}  // namespace meshorder::command
