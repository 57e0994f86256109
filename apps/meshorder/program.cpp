// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "program.hpp"

#include "command.hpp"
#include "interruption.hpp"
#ifdef MESHORDER_HAS_HDF5
#include "io/hdf5/mutex.hpp"
#endif
#include "io/stream/descriptor.hpp"
#include "io/stream/scratch.hpp"
#include "standard_streams.hpp"
#include "usage.hpp"
#include <meshorder/error.hpp>
#include <meshorder/registry.hpp>

#include <CLI/CLI.hpp>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

// Variables of Open MPI, of MPICH and its derivatives, of PMIx and of Slurm. Slurm's variables describe the
// step that a process belongs to.
constexpr std::array kSizes{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};
constexpr std::array kRanks{"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK", "SLURM_PROCID"};

/// Returns the value of the first environment variable in `names` that is set; null if none is set.
template <class Names>
const char* first_set(const Names& names) {
  const char* value = nullptr;
  for (const char* const name : names) {
    if (value == nullptr) value = std::getenv(name);
  }
  return value;
}

/// If the C library is glibc, keeps freed memory in the process for later allocations of any thread. By
/// default, glibc returns blocks of 32 MiB and more to the system, which clears every page again for the next
/// block; this costs a sixth of the time of `meshorder order` for a mesh of 1.8 million vertices. Keeping
/// them raises the peak of the memory in use by up to a fifth.
void keep_freed_memory() noexcept {
#if defined(__GLIBC__)
  (void)mallopt(M_MMAP_MAX, 0);         // no blocks outside the heap
  (void)mallopt(M_TRIM_THRESHOLD, -1);  // no memory of the heap goes back to the system
  (void)mallopt(M_ARENA_MAX, 1);        // one heap for all threads: each can use what another freed
#endif
}

/// Adds to the parser the options that all programs have, then those of `program`.
void describe(const Program& program, CLI::App& app, std::vector<std::string>& arguments) {
  app.name("meshorder");
  app.set_version_flag("-V,--version", MESHORDER_VERSION);
  app.require_subcommand(1);
  app.fallthrough();  // subcommands take --plugin, too
  app.add_option_function<std::vector<std::string>>(
         "--plugin",
         [](const std::vector<std::string>& files) {
           for (const std::string& file : files) load_methods(file);
         },
         "Shared library with methods of your own (see examples/own_method.cpp); may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->trigger_on_parse();
  app.formatter(help_format());
  program.describe(app, arguments);
  refuse_empty_values(app);
}

/// Runs the subcommand that the arguments name; returns the exit status.
int run(const Program& program, std::vector<std::string> arguments) {
  CLI::App app;
  describe(program, app, arguments);
  if (arguments.empty()) {
    write_stderr(app.help());
    return kBadInput;
  }
  if (const auto fault = option_without_value(arguments)) return report_failure(*fault, kBadInput);
  arguments = with_words_as_options(std::move(arguments));
  std::reverse(arguments.begin(), arguments.end());  // the parser expects the arguments in reverse
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::Success& asked_for_help) {
    if (const auto fault = unknown_command(app)) return report_failure(*fault, kBadInput);
    std::ostringstream text;
    app.exit(asked_for_help, text);
    write_stdout(text.str());
  } catch (const CLI::ParseError& error) {
    return report_failure(usage_fault(app, error), kBadInput);
  }
  flush_stdout();
  return 0;
}

/// Returns whether a failure is that the system starts no further thread: oneTBB says so in a text, and
/// std::thread by an error number.
bool is_lack_of_threads(const std::exception& failure) {
  const auto* const error = dynamic_cast<const std::system_error*>(&failure);
  return std::string_view(failure.what()).find("pthread_create") != std::string_view::npos ||
         (error != nullptr && error->code() == std::errc::resource_unavailable_try_again);
}

/// Runs the program and reports failures; returns the exit status.
int run_and_report(const Program& program, int argc, char** argv) {
  try {
    return run(program, {argv + std::min(argc, 1), argv + argc});
  } catch (const CommandError& error) {
    return report_failure(error.what(), error.status);
  } catch (const Error& error) {
    return report_failure(error.what(), error.code() == Code::internal ? kOwnFailure : kBadInput);
  } catch (const std::filesystem::filesystem_error& error) {
    const SystemFault fault = system_fault(error.code().value());
    const std::filesystem::path& place = error.path2().empty() ? error.path1() : error.path2();
    return report_failure(InputError(place.string(), fault.reason, fault.remedy).what(), kBadInput);
  } catch (const std::bad_alloc&) {
    return report_failure("out of memory", kOwnFailure);
  } catch (const std::exception& error) {
    if (!is_lack_of_threads(error)) return report_failure(error.what(), kOwnFailure);
    return report_failure(
        "no thread can be started; give --threads 1, or raise the limit on processes (ulimit -u)", kBadInput);
  } catch (...) {
    return report_failure("unknown failure", kOwnFailure);
  }
}

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): read when the process ends
bool has_run = false;

/// Runs at the end of the process. If a library ended it, as libhdf5 does when memory runs out, removes
/// unfinished outputs and reports a failure.
extern "C" void report_end_by_a_library() {
  if (has_run) return;
  remove_unfinished_outputs();
  std::_Exit(report_failure("a library has ended the process; is there enough memory?", kOwnFailure));
}

}  // namespace

void prepare_process() {
  keep_freed_memory();
  occupy_closed_streams();
#ifdef MESHORDER_HAS_HDF5
  hdf5::close_nothing_at_exit();
#endif
}

int run_program(const Program& program, int argc, char** argv) noexcept {
  prepare_process();
  clean_up_at_signals();
  (void)std::atexit(report_end_by_a_library);
  std::optional<int> status;
  if (program.hand_over != nullptr) status = program.hand_over(argv);
  if (!status) status = run_and_report(program, argc, argv);
  has_run = true;
  return *status;
}

bool is_started_as_rank() { return first_set(kSizes) != nullptr || first_set(kRanks) != nullptr; }

bool is_one_of_several() {
  const char* const size = first_set(kSizes);
  // PMIx sets only the rank
  return size != nullptr ? std::atoi(size) > 1 : std::getenv("PMIX_RANK") != nullptr;
}

bool is_first_process() {
  const char* const rank = first_set(kRanks);
  return rank == nullptr || std::atoi(rank) == 0;
}

}  // namespace meshorder::command
