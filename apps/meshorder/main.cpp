// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "freed_memory.hpp"
#include "hand_over.hpp"
#include "help_format.hpp"
#include "interruption.hpp"
#ifdef MESHORDER_HAS_HDF5
#include "io/hdf5/process_end.hpp"
#endif
#include "io/stream/scratch.hpp"
#include "standard_streams.hpp"
#include "usage.hpp"
#include <meshorder/error.hpp>
#include <meshorder/registry.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using meshorder::command::report_failure;

constexpr int kBadInput = 2;
constexpr int kOwnFailure = 1;

struct Subcommand {
  const char* name;
  void (*add)(CLI::App& subcommand);
};

/// In the order of the help.
constexpr std::array kSubcommands{
    Subcommand{"order", meshorder::command::add_order},
    Subcommand{"apply", meshorder::command::add_apply},
    Subcommand{"info", meshorder::command::add_info},
    Subcommand{"compare", meshorder::command::add_compare},
    Subcommand{"try", meshorder::command::add_try},
    Subcommand{"openfoam", meshorder::command::add_openfoam},
    Subcommand{"calibrate", meshorder::command::add_calibrate},
    Subcommand{"simulate", meshorder::command::add_simulate},
    Subcommand{"reproduce", meshorder::command::add_reproduce},
    Subcommand{"report", meshorder::command::add_report},
    Subcommand{"models", meshorder::command::add_models},
    Subcommand{"methods", meshorder::command::add_methods},
    Subcommand{"serve-steps", meshorder::command::add_serve_steps},
};

/// Gives the command its options and subcommands.
void describe(CLI::App& app) {
  app.description(
      "Reorders the vertices and elements of a simulation mesh, with all data in its file, so that\n"
      "simulations on it run faster.\n\n"
      "  meshorder order  dragon.veg -o ordered.veg   order by the method chosen for the mesh\n"
      "  meshorder info   dragon.veg                  counts and spans; is it in a good order?\n"
      "  meshorder compare dragon.veg                 every order: cost, quality, measured kernels\n"
      "  meshorder try wing.su2 -- SU2_CFD wing.cfg {} your own program in several orders\n"
      "  meshorder openfoam cavity                    order the cells of an OpenFOAM case\n"
      "  meshorder calibrate                          measure this machine, for info's predictions\n"
#ifdef MESHORDER_HAS_LAB
      "  meshorder simulate falling --mesh dragon.veg simulate an elastic body and time it\n"
      "  meshorder reproduce -o results               the paper's study on this machine, as a page\n"
      "  meshorder report dragon.veg                  mesh, orders and kernels as a page for the browser\n"
#endif
  );
  app.name("meshorder");
  app.set_version_flag("-V,--version", MESHORDER_VERSION);
  app.require_subcommand(1);
  app.fallthrough();  // subcommands take --plugin, too
  app.add_option_function<std::vector<std::string>>(
         "--plugin",
         [](const std::vector<std::string>& files) {
           for (const std::string& file : files) meshorder::load_methods(file);
         },
         "Shared library with methods of your own (see examples/own_method.cpp); may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->trigger_on_parse();
  app.formatter(meshorder::command::help_format());
  for (const auto& [name, add] : kSubcommands) add(*app.add_subcommand(name));
  meshorder::command::refuse_empty_values(app);
}

/// Runs what the arguments ask for; returns the exit status.
int run(std::vector<std::string> arguments) {
  CLI::App app;
  describe(app);
  if (arguments.empty()) {
    meshorder::command::write_stderr(app.help());
    return kBadInput;
  }
  meshorder::command::take_program_to_try(arguments);
  if (const auto fault = meshorder::command::option_without_value(arguments))
    return report_failure(*fault, kBadInput);
  arguments = meshorder::command::with_words_as_options(std::move(arguments));
  std::reverse(arguments.begin(), arguments.end());  // as the parser takes them
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::Success& asked_for_help) {
    if (const auto fault = meshorder::command::unknown_command(app)) return report_failure(*fault, kBadInput);
    std::ostringstream text;
    app.exit(asked_for_help, text);
    meshorder::command::write_stdout(text.str());
  } catch (const CLI::ParseError& error) {
    return report_failure(meshorder::command::usage_fault(app, error), kBadInput);
  }
  meshorder::command::flush_stdout();
  return 0;
}

/// Runs the command; returns the exit status.
int run_and_report(int argc, char** argv) {
  try {
    return run({argv + std::min(argc, 1), argv + argc});
  } catch (const meshorder::command::CommandError& error) {
    return report_failure(error.what(), error.status);
  } catch (const meshorder::Error& error) {
    return report_failure(error.what(), error.code() == meshorder::Code::internal ? kOwnFailure : kBadInput);
  } catch (const std::bad_alloc&) {
    return report_failure("out of memory", kOwnFailure);
  } catch (const std::exception& error) {
    return report_failure(error.what(), kOwnFailure);
  } catch (...) {
    return report_failure("an unknown failure", kOwnFailure);
  }
}

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): read at the end of the process
bool has_run = false;

/// At the end of the process: libhdf5 ends it by itself where it has no memory.
extern "C" void tell_if_a_library_ended_it() {
  if (has_run) return;
  meshorder::remove_unfinished_outputs();
  std::_Exit(report_failure("a library has ended the process; is there enough memory?", kOwnFailure));
}

}  // namespace

int main(int argc, char** argv) {
  meshorder::command::keep_freed_memory();
  meshorder::command::occupy_closed_streams();
  meshorder::command::clean_up_at_signals();
  (void)std::atexit(tell_if_a_library_ended_it);
#ifdef MESHORDER_HAS_HDF5
  meshorder::hdf5::close_nothing_at_exit();
#endif
  const std::optional<int> handed_over = meshorder::command::hand_over_to_mpi(argv);
  const int status = handed_over ? *handed_over : run_and_report(argc, argv);
  has_run = true;
  return status;
}
