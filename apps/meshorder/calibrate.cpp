// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/host.hpp"
#include "base/parallel.hpp"
#include "command.hpp"
#include "console.hpp"
#include "payoff/calibration_store.hpp"
#include "payoff/machine_choice.hpp"
#include "progress.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>

namespace meshorder::command {
namespace {

using Json = nlohmann::ordered_json;

struct CalibrateArguments : Common {
  bool list = false;
  bool recheck = false;
  double seconds = CalibrationEffort{}.seconds;
};

/// Returns the result of `work`; meanwhile shows its progress on the terminal unless --quiet is given.
template <class Work>
auto watched(const CalibrateArguments& arguments, const std::string& what, const Work& work) {
  Progress progress(!arguments.quiet);
  progress.stage(what, 0, 1);
  Run run;
  run.progress = [&](const meshorder::Progress& now) {
    progress.at(now.fraction);
    return true;
  };
  return in_call(run, work);
}

std::string in_bytes(Offset bytes) { return to_string(Caches{{bytes}}); }

std::string in_columns(const KernelCosts& costs) {
  // rounds costs to multiples of 0.0001 ns
  const auto cell = [](double cost, int width) {
    return fmt::format(" {:>{}.3g}", std::round(1e4 * cost) / 1e4, width - 1);
  };
  std::string misses;
  std::string jumps;
  for (std::size_t i = 0; i < costs.miss.size(); ++i) {
    misses += cell(costs.miss[i], 8);
    jumps += cell(costs.jump[i], 8);
  }
  return cell(costs.access, 7) + misses + jumps + cell(costs.turn, 7);
}

/// Prints two lines for each kernel: costs for tetrahedra, then for triangles.
void print_costs(const Console& console, const CostModel& model, const FitQuality& quality) {
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    console.print("{:<14}{}{:>10.0f}{:>6.1f}%{:>6.1f}%", kKernelTitles[k], in_columns(model.solid[k]),
                  quality.condition[k], 100 * quality.error[k], 100 * quality.floor[k]);
    console.print("{:<14}{}", "", in_columns(model.flat[k]));
  }
}

void print_calibration(const Console& console, const Calibration& calibration) {
  console.print("{}", calibration.processor);
  console.print("{:<10} {:>10} {:>10} {:>10} {:>12}", "", "reported", "found", "used", "latency");
  const auto cell = [](const auto& levels, std::size_t i, auto text_of) {
    return i < levels.size() ? text_of(levels[i]) : std::string("–");
  };
  const std::vector<Offset>& reported = calibration.reported.level_bytes;
  const std::vector<Offset>& used = calibration.model.caches.level_bytes;
  const std::vector<FoundCache>& found = calibration.found.levels;
  for (std::size_t i = 0; i < std::max({reported.size(), used.size(), found.size()}); ++i) {
    console.print(
        "{:<10} {:>10} {:>10} {:>10} {:>12}", fmt::format("cache {}", i + 1), cell(reported, i, in_bytes),
        cell(found, i, [](const FoundCache& level) { return in_bytes(level.bytes); }),
        cell(used, i, in_bytes),
        cell(found, i, [](const FoundCache& level) { return fmt::format("{:.1f} ns", level.nanoseconds); }));
  }
  console.print("{:<10} {:>10} {:>10} {:>10} {:>12}", "memory", "", "", "",
                fmt::format("{:.0f} ns", calibration.found.memory_nanoseconds));
  console.print("read       {:.1f} GB/s on one thread, {:.1f} GB/s on {}", calibration.read_bandwidth,
                calibration.read_bandwidth_all, calibration.threads);
  console.print(
      "\nCosts of a kernel, in ns: of an access, of a cache miss, of a jump and of a turn. A jump is a miss\n"
      "that no prefetcher predicts; its cost is added to that of the miss. Misses and jumps have four\n"
      "columns: for the first cache, the second, half of the last, and all of it. A turn is a loop end that\n"
      "the processor did not predict. The first line of each kernel is for tetrahedra, the second for\n"
      "triangles");
  console.print("{:<14}{:>7}{:>32}{:>32}{:>7}{:>10}{:>7}{:>7}", "", "access", "misses", "jumps", "turn",
                "condition", "error", "floor");
  print_costs(console, calibration.model, calibration.quality);
  if (calibration.threads > 1) {
    console.print("on {} threads, in elapsed ns:", calibration.threads);
    print_costs(console, calibration.all_threads, calibration.all_threads_quality);
  }
  console.print(
      "condition: factor by which errors of the measured times can grow in these costs. error: median error\n"
      "of predicted times, for the runs to which the costs were fitted. floor: difference between two\n"
      "timings of one run at different addresses");
}

void list_machines(const Console& console) {
  auto list = Json::array();
  const StoredCalibration stored = load_calibration(key_of_this_machine());
  const std::string date = stored.calibration ? stored.calibration->date : "";
  console.print_list("  {:<8} {}", "this",
                     date.empty() ? "this machine, not calibrated" : "this machine, calibrated " + date);
  list.push_back({{"name", "this"}, {"machine", processor_of_this_machine()}, {"calibrated", or_null(date)}});
  for (const ShippedMachine& machine : shipped_machines()) {
    console.print_list("  {:<8} {}", machine.name, machine.costs().machine);
    list.push_back({{"name", machine.name}, {"machine", machine.costs().machine}, {"calibrated", nullptr}});
  }
  console.print_json({{"machines", list}});
}

void recheck_machine(const CalibrateArguments& arguments, Console& console) {
  const StoredCalibration stored = load_calibration(key_of_this_machine());
  if (!stored.calibration) {
    throw CommandError(stored.fault.empty()
                           ? "this machine is not calibrated; `meshorder calibrate` calibrates it"
                           : stored.fault + "; `meshorder calibrate` measures it again",
                       2);
  }
  const Recheck found =
      watched(arguments, "rechecking this machine", [&] { return recheck(*stored.calibration); });
  if (!found.doubt.empty()) console.warn(found.doubt + "; recheck when it is idle");
  console.print("Time now / time predicted by the calibration of {}", stored.calibration->date);
  Json ratios;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    console.print("{:<14} {:.2f}", kKernelTitles[k], found.ratio[k]);
    ratios[std::string(to_string(kKernels[k]))] = found.ratio[k];
  }
  console.print("{}", found.moved.empty() ? "not changed" : found.moved);
  console.print_json(
      {{"calibrated", stored.calibration->date}, {"ratio", ratios}, {"moved", !found.moved.empty()}});
}

void run(const CalibrateArguments& arguments) {
  Console console(arguments);
  if (arguments.list) return list_machines(console);
  if (arguments.recheck) return recheck_machine(arguments, console);
  const Calibration calibration = watched(arguments, "measuring this machine",
                                          [&] { return measure_machine(effort_of(arguments.seconds)); });
  if (const std::string doubt = reason_to_doubt(calibration.steadiness); !doubt.empty())
    console.warn(doubt + "; calibrate again when it is idle");
  std::string file;
  try {
    file = save_calibration(calibration).string();
  } catch (const Error& error) {
    console.warn(error.what());
  }
  print_calibration(console, calibration);
  if (!file.empty()) console.print("kept in    {}", file);
  Json result = Json::parse(to_json_text(calibration));
  result["file"] = or_null(file);
  console.print_json(result);
}

}  // namespace

void add_calibrate(CLI::App& subcommand) {
  subcommand.description(
      "Measure this machine, so that `info` can predict times for it: caches, latencies, bandwidths, and\n"
      "the cost of cache misses in each kernel, on one thread and on all. The result is kept for this\n"
      "processor and this build in $MESHORDER_CACHE, else in $XDG_CACHE_HOME/meshorder, else in\n"
      "~/.cache/meshorder. The first `info --predict` calibrates, too, in 40 to 60 s, unless --machine or\n"
      "$MESHORDER_MACHINE names another machine.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder calibrate\n"
      "  meshorder calibrate --recheck");
  const auto arguments = std::make_shared<CalibrateArguments>();
  CLI::Option* const list = subcommand.add_flag(
      "--list", arguments->list, "List the machines that --machine takes, and do nothing else");
  subcommand
      .add_flag("--recheck", arguments->recheck,
                "Run the kernels for some seconds, and say whether the machine has changed since the\n"
                "calibration")
      ->excludes(list);
  subcommand.add_option("--budget", arguments->seconds, "Seconds to spend")
      ->check(positive())
      ->capture_default_str();
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
