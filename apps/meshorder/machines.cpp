// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "machines.hpp"

#include "base/parallel.hpp"
#include "payoff/calibration_store.hpp"
#include "standard_streams.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>

#include <cstdlib>

namespace meshorder::command {

void add_machine_option(CLI::App& subcommand, std::string& machine) {
  subcommand
      .add_option("--machine", machine,
                  "Machine to predict for: this, or one that `meshorder calibrate --list` names\n"
                  "(default: $MESHORDER_MACHINE, else this)")
      ->type_name("NAME");
}

void add_all_threads_option(CLI::App& subcommand, bool& all_threads) {
  subcommand.add_flag("--all-threads", all_threads,
                      "Judge kernels that run on all threads, not on one; see --threads.\n"
                      "Predictions then need a calibration of this machine");
}

void add_kernels_option(CLI::App& subcommand, KernelSet& kernels) {
  subcommand
      .add_option_function<std::string>(
          "--kernels", [&kernels](const std::string& name) { kernels = parse_kernels(name); },
          "Kernels to run: `plain`, as in most programs, or `tuned`, as in `meshorder simulate`. Tuned\n"
          "kernels prefetch and work on blocks, and are equally fast in all good orders")
      ->type_name("SET")
      ->default_str("plain");
}

namespace {

/// Returns MESHORDER_CALIBRATION_SECONDS if above 0, else the default of `meshorder calibrate`, in seconds.
double seconds_to_calibrate() {
  const char* const variable = std::getenv("MESHORDER_CALIBRATION_SECONDS");
  const double seconds = variable == nullptr ? 0 : std::strtod(variable, nullptr);
  return seconds > 0 ? seconds : CalibrationEffort{}.seconds;
}

}  // namespace

MachineChoice calibrated(MachineChoice choice, bool all_threads, Progress& progress, bool quiet,
                         Notes& notes) {
  if (!choice.stands_in) return choice;
  if (!choice.fault.empty()) notes.push_back(choice.fault + "; this machine is measured again");
  if (!quiet) {
    write_stderr("meshorder: measuring this machine once, 40 to 60 s; `--machine zen3` predicts without\n");
  }
  progress.stage("measuring this machine", 0, 0.9);
  Run run;
  run.progress = [&](const meshorder::Progress& now) {
    progress.at(0.9 * now.fraction);
    return true;
  };
  const Calibration calibration =
      in_call(run, [] { return measure_machine(effort_of(seconds_to_calibrate())); });
  if (const std::string doubt = reason_to_doubt(calibration.steadiness); !doubt.empty()) {
    notes.push_back(
        "this machine was calibrated while it was busy; `meshorder calibrate` calibrates it again: " + doubt);
  }
  try {
    (void)save_calibration(calibration);
  } catch (const Error& error) {
    notes.push_back(std::string(error.what()) + "; every prediction measures this machine again");
  }
  return chosen(calibration, all_threads);
}

}  // namespace meshorder::command
