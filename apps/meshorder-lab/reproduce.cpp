// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "command.hpp"
#include "console.hpp"
#include "interruption.hpp"
#include "lab.hpp"
#include "lab/fluid/triangulation.hpp"
#include "lab/report/page/study_page.hpp"
#include "lab/report/tables/each_table.hpp"
#include "lab/study/results_json.hpp"
#include "lab/study/stepper.hpp"
#include "lab/study/study_run.hpp"
#include "progress.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

/// With --quick, seconds for all orders of a scenario together.
constexpr double kQuickSeconds = 20;

struct ReproduceArguments : Common {
  std::string folder = "results";
  bool is_folder_named = false;  ///< the user named the folder
  bool quick = false;
  bool full = false;
  StudyPlan plan;
  std::vector<std::string> orders;
  Index steps = 0;
  bool no_pin = false;
};

StudyPlan plan_of(const ReproduceArguments& arguments, Console& console) {
  StudyPlan plan = arguments.plan;
  if (plan.scenarios.empty()) {
    plan.scenarios = study_scenarios();
    const bool has_mesh = !plan.mesh.empty();
    if (has_mesh || !has_delaunay_program()) {
      std::erase(plan.scenarios, "splash");
      if (!has_mesh) console.warn("splash is left out: it needs the program meshorder-delaunay");
    }
  }
  for (const std::string& order : arguments.orders) {
    OrderingSpec ordering = study_ordering(order);
    if (find_named(plan.orderings, ordering.name) == nullptr) plan.orderings.push_back(std::move(ordering));
  }
  plan.threads = arguments.threads > 0 ? arguments.threads : thread_count();
  plan.pin = !arguments.no_pin;
  if (arguments.steps > 0) plan.steps = arguments.steps;
  if (!arguments.quick) return plan;
  plan.runs = 1;
  if (!plan.steps) plan.scenario_seconds = kQuickSeconds;
  return plan;
}

/// Writes the report of a study, finished or not, and prints its findings.
void report(Console& console, const StudyFolder& folder, Progress& progress) {
  progress.stage("the report", 0.99, 1);
  const WrittenReport written = write_report(folder);
  progress.finish();
  console.warn_of(written.notes);
  // one row for each order: the page's table is too wide for a terminal
  const Table speedups = speedup_table(written.results);
  if (!speedups.rows.empty()) console.print("{}", to_text(speedups));
  for (const std::string& finding : written.findings) console.print("{}\n", finding);
  for (const std::filesystem::path& file : written.files) {
    if (file.extension() != ".svg") console.print("wrote {}", file.string());
  }
  console.print_json({{"folder", folder.root().string()},
                      {"page", folder.page().string()},
                      {"results", to_json(written.results)}});
}

void run(const ReproduceArguments& arguments) {
  Console console(arguments);
  const StudyPlan plan = plan_of(arguments, console);
  const StudyFolder folder(arguments.folder, arguments.is_folder_named);
  Progress progress(!console.quiet());
  const Interruption interruption;
  StudyObserver observer;
  observer.stage = [&](const std::string& what, double from, double to) { progress.stage(what, from, to); };
  observer.note = [&](const std::string& message) { console.warn(message); };
  observer.stop = [] { return Interruption::signal() != 0; };
  const bool finished = run_study(plan, folder, std::filesystem::read_symlink("/proc/self/exe"), observer);
  if (finished || std::filesystem::exists(folder.results())) report(console, folder, progress);
  if (!finished)
    throw CommandError(
        fmt::format("stopped; finished runs are kept in {}, and the same command continues from there",
                    arguments.folder),
        128 + Interruption::signal());
}

}  // namespace

void add_reproduce(CLI::App& subcommand) {
  subcommand.footer(
      "Examples:\n"
      "  meshorder reproduce --quick -o results   a few steps of each scenario: some minutes\n"
      "  meshorder reproduce -o results           240 steps, three runs: hours; stop it with Ctrl-C and\n"
      "                                           resume it later with the same command");
  const auto arguments = std::make_shared<ReproduceArguments>();
  arguments->threads = 1;
  StudyPlan& plan = arguments->plan;
  subcommand
      .add_option("-o,--output", arguments->folder,
                  "Folder for the results; an unfinished study in it is resumed")
      ->each([named = &arguments->is_folder_named](const std::string& /*folder*/) { *named = true; })
      ->capture_default_str();
  CLI::Option* const quick = subcommand.add_flag("--quick", arguments->quick, "One run of a few steps");
  subcommand.add_flag("--full", arguments->full, "All steps, three runs (default)")->excludes(quick);
  subcommand.add_option(
      "--scenario", plan.scenarios,
      "A scenario's name or file, see `meshorder simulate`; may be repeated (default: all)");
  subcommand.add_option("--mesh", plan.mesh, "Mesh instead of the scenarios' own: a model's name or a file");
  subcommand.add_option("--size", plan.size, "Size of the meshes: paper, 300k or 2m vertices")
      ->capture_default_str();
  subcommand
      .add_option("--orders", arguments->orders,
                  "Orders besides the six above: VERTICES/ELEMENTS, separated by commas")
      ->delimiter(',');
  subcommand.add_option("--runs", plan.runs, "Runs of each scenario in each order")
      ->check(in_range(1, 1000))
      ->excludes(quick)
      ->capture_default_str();
  subcommand.add_option("--steps", arguments->steps, "Number of steps instead of the scenarios' own")
      ->check(in_range(1, 1'000'000));
  subcommand
      .add_option("--budget", plan.kernel_seconds, "Seconds to spend on running the kernels, for each mesh")
      ->check(positive())
      ->capture_default_str();
  subcommand.add_flag("--no-pin", arguments->no_pin, "Do not bind threads to processors");
  add_ordering_options(subcommand, plan.ordering);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { run(*arguments); });
}

void add_serve_steps(CLI::App& subcommand) {
  subcommand.description("Serve a study: read tasks on standard input and simulate them");
  subcommand.group("");  // the help omits this subcommand, which only `reproduce` starts
  const auto arguments = std::make_shared<Common>();
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback(
      [arguments] { with_threads(arguments->threads, [] { serve_steps(std::cin, std::cout); }); });
}

}  // namespace meshorder::command
