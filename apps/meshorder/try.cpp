// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "console.hpp"
#include "io/stream/output_file.hpp"
#include "progress.hpp"
#include "trial.hpp"
#include "trial_subject.hpp"
#include "try_report.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

// options that `order` has as well
constexpr std::array kPassedOn{"--for", "--seed", "--limit-memory", "--allow-includes-from", "--trust"};

struct TryArguments : Common, TrialOptions {
  std::string input;
  std::string ids = "renumber";
  std::string page;
  std::vector<std::string> to_order;  ///< options that are passed on to `order`
  OrderOptions ordering;
};

/// Throws if there is no program to try.
void check_program(const TryArguments& arguments) {
  if (!arguments.command.empty()) return;
  const bool is_case = fs::is_directory(arguments.input) || fs::path(arguments.input).extension() == ".foam";
  throw InvalidArgument(
      fmt::format("there is no program to try: write it after --, as in meshorder try {} -- {}",
                  in_shell(arguments.input), is_case ? "icoFoam" : "solver {}"));
}

/// Returns the first path in a word that leads to one of the originals, as in --mesh=PATH or -oPATH; "" if
/// none does.
std::string original_in(const std::string& word, const std::vector<fs::path>& originals) {
  constexpr std::string_view kBetween = " \t\n=:,;@(){}'\"<>|&";
  const auto leads_there = [&](const std::string& path) {
    return std::ranges::any_of(originals, [&](const fs::path& original) {
      std::error_code ignored;
      return fs::equivalent(path, original, ignored);
    });
  };
  for (std::size_t at = word.find('/'); at != std::string::npos; at = word.find('/', at + 1)) {
    const bool is_after_letter = at == 2 && word.front() == '-';
    if (at > 0 && !is_after_letter && kBetween.find(word[at - 1]) == std::string_view::npos) continue;
    for (std::size_t end = at; end != std::string::npos;) {
      end = word.find_first_of(kBetween, end + 1);
      if (std::string path = word.substr(at, end - at); leads_there(path)) return path;
    }
  }
  return {};
}

/// Throws if a word of the command names an original: each run would then read or write that, and not a copy.
void check_that_no_original_is_named(const TrialOptions& options, const TrialSubject& subject) {
  const std::vector<fs::path> originals = subject.originals();
  for (auto word = options.command.begin() + 1; word != options.command.end(); ++word) {
    const std::string path = original_in(*word, originals);
    if (path.empty()) continue;
    const bool is_folder = subject.name() != "." && fs::is_directory(path);
    throw InvalidArgument(fmt::format("{}: each run needs its own copy of it; write {} in its place", path,
                                      is_folder ? ". (the folder of the copy)" : "{}"));
  }
}

/// Throws unless the command names the mesh (not needed for a case) and --keep is a new or empty folder.
void check_command(const TrialOptions& options, const TrialSubject& subject) {
  if (subject.name() != "." &&
      std::none_of(options.command.begin() + 1, options.command.end(), [](const std::string& word) {
        return word.find("{}") != std::string::npos || word.find("{stem}") != std::string::npos;
      })) {
    throw InvalidArgument(
        "the command has no {}, which is replaced by the mesh: write it where the program takes the mesh");
  }
  const bool is_new_or_empty =
      !fs::exists(options.keep) || (fs::is_directory(options.keep) && fs::is_empty(options.keep));
  if (!options.keep.empty() && !is_new_or_empty)
    throw InputError(options.keep, "it already exists", "name a folder that is new or empty");
}

void run(const TryArguments& arguments) {
  Console console(arguments);
  check_program(arguments);
  const std::unique_ptr<TrialSubject> subject =
      trial_subject(arguments.input, {arguments.threads, arguments.ids, arguments.to_order});
  check_command(arguments, *subject);
  check_that_no_original_is_named(arguments, *subject);
  for (const std::string& name : arguments.methods) subject->check_order(name);
  std::optional<OutputFile> page;  // throws, before anything runs, if the page cannot be written
  if (!arguments.page.empty()) {
    std::error_code ignored;
    if (fs::equivalent(arguments.page, arguments.input, ignored))
      throw InvalidArgument("--page " + arguments.page + ": that is the mesh; name another file");
    page.emplace(arguments.page);
  }
  Progress progress(!console.quiet());
  Notes notes;
  const TrialReport report = run_trial(*subject, arguments, progress, notes);
  progress.finish();
  console.warn_of(notes);
  print_trial(console, report);
  if (page) {
    page->write(trial_page(report));
    page->commit();
    console.print("\nwrote {}", arguments.page);
  }
  if (!arguments.keep.empty()) console.print("\nkept {}", arguments.keep);
  nlohmann::ordered_json result{{"file", arguments.input}};
  result.update(to_json(report));
  console.print_json(result);
}

/// Returns the options on the command line that `order` has as well.
std::vector<std::string> passed_on(const CLI::App& subcommand) {
  std::vector<std::string> words;
  const auto add = [&](const CLI::Option* option) {
    for (const std::string& value : option->results()) {
      words.push_back("--" + option->get_lnames().front());
      if (option->get_items_expected_max() > 0) words.push_back(value);
    }
  };
  for (const char* const name : kPassedOn) add(subcommand.get_option(name));
  add(subcommand.get_parent()->get_option("--plugin"));
  return words;
}

/// Returns the words after `--`.
std::vector<std::string>& program_to_try() {
  static std::vector<std::string> words;
  return words;
}

/// Returns the command line of this trial, without --keep, whose folder exists after the trial.
std::string& call_of_this_trial() {
  static std::string call;
  return call;
}

/// Adds the options for the orders, the budget, the times and the results to compare.
void add_trial_options(CLI::App& subcommand, TryArguments& arguments) {
  subcommand
      .add_option("--methods", arguments.methods,
                  "Orders to try, VERTICES or VERTICES/ELEMENTS, separated by commas (default:\n"
                  "auto,hilbert,rcm,spectral-fronts,hilbert-fronts; for an OpenFOAM case\n"
                  "auto,renumberMesh,bfs,fiedler,hilbert)")
      ->delimiter(',')
      ->allow_extra_args(false);
  subcommand
      .add_option("--budget", arguments.budget_seconds,
                  "Seconds for all runs of the program. If they are too few, the last orders are left out;\n"
                  "orders of --methods share the time if each can run twice")
      ->check(positive())
      ->capture_default_str();
  subcommand.add_option("--timeout", arguments.timeout_seconds, "Seconds after which a run counts as failed")
      ->check(positive())
      ->capture_default_str();
  subcommand
      .add_option(
          "--time", arguments.time,
          "Time to compare: `cpu`, the processor time of the program and of all that it starts; `wall`, the\n"
          "time by the clock; or a regular expression with a group, which captures a time in the program's\n"
          "output (the last match counts)")
      ->type_name("TIME")
      ->capture_default_str();
  subcommand
      .add_option(
          "--count", arguments.count,
          "Regular expression for a number that the program prints, such as iterations. It is shown for\n"
          "each order; a note names the orders in which it grows by a tenth or more")
      ->type_name("REGEX");
  subcommand
      .add_option("--same", arguments.same,
                  "Regular expression for numbers that the program prints. An order is left out if\n"
                  "its numbers differ from those of the first run")
      ->type_name("REGEX");
  subcommand
      .add_option(
          "--same-file", arguments.same_file,
          "Like --same, for all words of a file that the program writes: {out} or a path in its folder,\n"
          "such as {stem}.dat. Only for files that do not depend on the order of the mesh")
      ->type_name("FILE");
  subcommand
      .add_option(
          "--tolerance", arguments.tolerance,
          "Relative difference up to which numbers count as equal. Differences below 1e-12 of the largest\n"
          "number compared never count")
      ->check(positive())
      ->capture_default_str();
  subcommand
      .add_option(
          "--with", arguments.with,
          "Names of the files and folders beside the mesh that the program needs, separated by commas\n"
          "(default: all that are not hidden)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAMES");
  subcommand.add_flag(
      "--unprotected", arguments.is_unprotected,
      "Let the program write wherever you may: for sudo, containers, and programs that write\n"
      "to the folder of the mesh by its full path. A change of an original ends the trial");
}

}  // namespace

void take_program_to_try(std::vector<std::string>& arguments) {
  const auto mark = std::find(arguments.begin(), arguments.end(), "--");
  if (mark == arguments.end() || std::find(arguments.begin(), mark, "try") == mark) return;
  std::string& call = call_of_this_trial();
  call = "meshorder";
  for (auto word = arguments.begin(); word != arguments.end(); ++word) {
    if (word < mark && *word == "--keep" && word + 1 < mark) {
      ++word;
    } else if (word >= mark || !word->starts_with("--keep=")) {
      call += ' ' + in_shell(*word);
    }
  }
  program_to_try().assign(mark + 1, arguments.end());
  arguments.erase(mark, arguments.end());
}

void add_try(CLI::App& subcommand) {
  subcommand.description(
      "Run a program of yours on a mesh as it is and in other orders, and say in which it runs faster.\n"
      "The program comes after --. In its arguments, {} is replaced by the mesh, {stem} by its name\n"
      "without extension, and {out} by a path for outputs. It runs without a shell, in a private\n"
      "folder with copies of the files beside the mesh. On Linux 6.2 and later, it cannot write to the\n"
      "folder of the mesh and to what links in it lead to, nor add files to the folders above.\n"
      "MESH may be the folder of an OpenFOAM case: the program then runs in copies of it.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder try wing.su2 -- SU2_CFD wing.cfg {}\n"
      "  meshorder try cavity -- icoFoam\n"
      "  meshorder try beam.inp --same-file {stem}.dat --tolerance 1e-3 -- ccx {stem}\n"
      "  meshorder try part.msh --methods auto,rcm --time 'solve: (.*) s' -- ./solver --mesh={} --out={out}");
  const auto arguments = std::make_shared<TryArguments>();
  subcommand
      .add_option("MESH", arguments->input, "Mesh file of a format that can be written, or OpenFOAM case")
      ->required();
  add_trial_options(subcommand, *arguments);
  subcommand
      .add_option("--keep", arguments->keep,
                  "New folder for the mesh and the outputs of the first run in each order")
      ->type_name("FOLDER");
  subcommand.add_option("--page", arguments->page, "Also write the findings as a page for the browser")
      ->type_name("FILE.html");
  add_ids_option(subcommand, arguments->ids);
  add_workload_option(subcommand, arguments->ordering);
  add_seed_option(subcommand, arguments->ordering.seed);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments, &subcommand] {
    arguments->command = program_to_try();
    arguments->call = call_of_this_trial();
    arguments->to_order = passed_on(subcommand);
    run(*arguments);
  });
}

}  // namespace meshorder::command
