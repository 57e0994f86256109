// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/communicator.hpp"
#include "interruption.hpp"
#include "io/stream/scratch.hpp"
#include "order.hpp"
#include "program.hpp"
#include "standard_streams.hpp"
#include "usage.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using meshorder::command::kBadInput;
using meshorder::command::kOwnFailure;
using meshorder::command::report_failure;
using meshorder::distributed::Communicator;

int status_of(const meshorder::Error& error) {
  return error.code() == meshorder::Code::internal ? kOwnFailure : kBadInput;
}

/// Prints why the command fails, on the first rank only; returns the status.
int report_at_root(const Communicator& communicator, const std::string& message, int status) {
  return communicator.is_root() ? report_failure(message, status) : status;
}

/// Options of `meshorder order` that are supported only in one process without parts.
constexpr std::array<std::string_view, 9> kOptionsOfOneProcess{"--elements",  "--group-by",    "--for",
                                                               "--tolerance", "--measure",     "--predict",
                                                               "--machine",   "--all-threads", "--timings"};

/// Returns an error message if the arguments have one of `kOptionsOfOneProcess`.
std::optional<std::string> option_of_one_process(const CLI::App& app) {
  for (const std::string& word : app.remaining(true)) {
    const std::string name = word.substr(0, word.find('='));
    if (std::ranges::find(kOptionsOfOneProcess, name) == kOptionsOfOneProcess.end()) continue;
    return "'" + name + "' is not supported with --parts or several ranks; leave it out";
  }
  return std::nullopt;
}

/// Runs the subcommand in the arguments, which are the same on all ranks; returns the exit status.
int run(const Communicator& communicator, bool is_started_as_rank, std::vector<std::string> arguments) {
  CLI::App app;
  app.description(
      "The program that `meshorder` runs if mpirun or srun starts several processes: orders a mesh on all\n"
      "ranks. The other commands run in one process, without mpirun.");
  app.name("meshorder-mpi");
  app.set_version_flag("-V,--version", MESHORDER_VERSION);
  app.require_subcommand(1);
  app.formatter(meshorder::command::help_format());
  meshorder::command::add_distributed_order(*app.add_subcommand("order"), communicator, is_started_as_rank);
  meshorder::command::refuse_empty_values(app);
  if (arguments.empty()) {
    if (communicator.is_root()) meshorder::command::write_stderr(app.help());
    return kBadInput;
  }
  if (const auto fault = meshorder::command::option_without_value(arguments))
    return report_at_root(communicator, *fault, kBadInput);
  arguments = meshorder::command::with_words_as_options(std::move(arguments));
  const std::string first = arguments.front();
  std::reverse(arguments.begin(), arguments.end());  // the parser expects the arguments in reverse
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::Success& asked_for_help) {
    std::ostringstream text;
    app.exit(asked_for_help, text);
    if (communicator.is_root()) meshorder::command::write_stdout(text.str());
  } catch (const CLI::ParseError& error) {
    if (meshorder::command::unknown_command(app))
      return report_at_root(communicator,
                            "with several ranks only `order` runs; start `" + first + "` without mpirun",
                            kBadInput);
    if (const auto fault = option_of_one_process(app)) return report_at_root(communicator, *fault, kBadInput);
    return report_at_root(communicator, meshorder::command::usage_fault(app, error), kBadInput);
  }
  if (communicator.is_root()) meshorder::command::flush_stdout();
  return 0;
}

/// Reports that MPI does not see the other processes started with this one; returns the status.
int report_launcher(bool is_first_process) {
  return is_first_process
             ? report_failure(
                   "the launcher started several processes, but MPI sees each of them alone: start "
                   "them with the mpirun of " +
                       meshorder::distributed::name_of_mpi(),
                   kBadInput)
             : kBadInput;
}

/// Ends all ranks after a failure of this rank: the other ranks do not know of the failure and might wait for
/// this rank.
[[noreturn]] void abort_all(const std::string& message) noexcept {
  meshorder::remove_unfinished_outputs();
  meshorder::distributed::Session::abort(report_failure(message, kOwnFailure));
}

}  // namespace

int main(int argc, char** argv) {
  meshorder::command::prepare_process();
  meshorder::command::clean_up_quietly_at_signals();
  // read before MPI changes the environment
  const bool is_one_of_several = meshorder::command::is_one_of_several();
  const bool is_first_process = meshorder::command::is_first_process();
  const bool is_started_as_rank = meshorder::command::is_started_as_rank();
  try {
    const meshorder::distributed::Session session(argc, argv);
    try {
      const Communicator communicator;
      if (communicator.size() == 1 && is_one_of_several) return report_launcher(is_first_process);
      try {
        return run(communicator, is_started_as_rank, {argv + std::min(argc, 1), argv + argc});
      } catch (const meshorder::distributed::SharedError& error) {
        return report_at_root(communicator, error.what(), status_of(error));
      }
    } catch (const std::bad_alloc&) {
      abort_all("out of memory");
    } catch (const std::exception& error) {
      abort_all(error.what());
    }
  } catch (const meshorder::Error& error) {
    return report_failure(error.what(), status_of(error));
  }
}
