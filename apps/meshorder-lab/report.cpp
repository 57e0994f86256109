// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "command.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "io/format.hpp"
#include "io/openfoam/cell_order.hpp"
#include "io/stream/output_file.hpp"
#include "lab.hpp"
#include "lab/report/comparison/comparison.hpp"
#include "lab/report/page/study_page.hpp"
#include "lab/study/folder.hpp"
#include "lab/study/mesh_study.hpp"
#include "lab/study/results_json.hpp"
#include "lab/support/machine.hpp"
#include "matrix_report.hpp"
#include "mesh/stored_matrix.hpp"
#include "payoff/advice.hpp"
#include "progress.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace meshorder::command {
namespace {
namespace fs = std::filesystem;

struct ReportArguments : Common {
  std::vector<std::string> inputs;
  /// File for the page. Empty: report.html (for a study, in its folder), or comparison.html for two studies.
  std::string output;
  double budget_seconds = TimingOptions{}.budget_seconds;
  OrderOptions ordering;
  std::string option_of_meshes;  ///< an option that was given but does not apply to studies; empty: none
};

constexpr std::string_view kAsItIs = "original";
constexpr std::string_view kOrdered = "meshorder";

std::vector<OrderingSpec> orderings_of_report() {
  return {{std::string(kAsItIs), "As it is", "original", "original"},
          {std::string(kOrdered), "meshorder order", "auto", "auto"},
          {"fiedler", "Fiedler", "fiedler", "original"},
          {"vf-fiedler", "VF Fiedler", "fiedler", "fiedler"},
          {"scrambled", "Scrambled", "scrambled", "scrambled"}};
}

/// Returns whether an order differs from another only in the elements, so that a matrix does not need it.
bool orders_elements(const OrderingSpec& ordering) { return ordering.name == "vf-fiedler"; }

/// Returns the predicted times of an order, and its measured times if all kernels have them.
OrderCosts costs_of(const MeshOrderRecord& order, std::size_t kernels) {
  OrderCosts costs;
  costs.predicted.emplace();
  bool measured = true;
  for (std::size_t k = 0; k < kernels; ++k) {
    (*costs.predicted)[k] = order.kernels[k].predicted_ms;
    measured = measured && order.kernels[k].measured_ms > 0;
  }
  if (!measured) return costs;
  costs.measured.emplace();
  for (std::size_t k = 0; k < kernels; ++k) (*costs.measured)[k] = order.kernels[k].measured_ms;
  return costs;
}

/// Adds the verdict of `info` from the times in this record, if the record has the orders that `info`
/// compares.
void add_verdict(MeshRecord& record, const Steadiness& steadiness, bool is_matrix) {
  const MeshOrderRecord* const as_it_is = find_order(record, kAsItIs);
  const MeshOrderRecord* const ordered = find_order(record, kOrdered);
  if (as_it_is == nullptr || ordered == nullptr) return;
  Advice advice;
  advice.is_matrix = is_matrix;
  advice.doubt = reason_to_doubt(steadiness);
  if (advice.doubt.empty()) advice.floor.fill(steadiness.repeat);
  const std::size_t kernels = kernels_of(advice).size();
  advice.as_is.costs = costs_of(*as_it_is, kernels);
  advice.candidates.push_back({.vertices = {ordered->vertex_method, "chosen by auto"},
                               .elements = {ordered->element_method, "chosen by auto"},
                               .costs = costs_of(*ordered, kernels),
                               .order_seconds = ordered->seconds});
  advice.kernels = kernel_advice(advice);
  record.verdict = to_string(advice);
  record.gain = certain_gain(advice).value_or(TimeRatio{0, 0, 0}).ratio;
}

/// Returns the file's name without its extension, with a number if another mesh has that name.
std::string unique_name(const std::string& file, const std::vector<MeshRecord>& others) {
  const std::string stem = fs::path(file).stem().string();
  std::string name = stem;
  for (int number = 2; find_named(others, name) != nullptr; ++number)
    name = fmt::format("{}-{}", stem, number);
  return name;
}

/// Reads a mesh, measures it in the report's orders and adds it to the page; returns its size in words.
/// Moves the progress from the share `from` to the share `to`.
std::string add_mesh(Page& page, const std::string& file, const ReportArguments& arguments,
                     Progress& progress, double from, double to, Notes& notes) {
  progress.stage("reading " + file, from, from + 0.1 * (to - from));
  const Mesh mesh = read_input(file, notes);
  const bool is_matrix = stored_matrix(mesh) != nullptr;
  if (mesh.cells.highest_dimension() < (is_matrix ? 1 : 2))
    throw InputError(
        file, is_matrix ? "has no entry off the diagonal" : "has neither volume cells nor a surface to show",
        "give a mesh with cells of two or three dimensions, or a matrix or graph");
  const std::string name = unique_name(file, page.results.meshes);
  MeshStudyOptions options;
  options.ordering = arguments.ordering;
  options.timing.budget_seconds = arguments.budget_seconds;
  options.hierarchies = {hierarchies_of_studies().front()};  // omits the caches of the paper's machine
  options.progress = [&](std::string_view what, double fraction) {
    progress.stage(fmt::format("{}: {}", name, what), from + (0.1 + 0.8 * fraction) * (to - from), to);
  };
  std::vector<OrderingSpec> orderings = page.results.orderings;
  if (is_matrix) std::erase_if(orderings, orders_elements);
  meshorder::OrderedMesh studied = study_mesh(mesh, orderings, options);
  studied.record.name = name;
  studied.record.file = file;
  add_verdict(studied.record, studied.steadiness, is_matrix);
  if (const std::string doubt = reason_to_doubt(studied.steadiness); !doubt.empty()) {
    notes.push_back(name + ": " + doubt);
    if (!studied.record.verdict.empty()) studied.record.verdict += ". But " + doubt;
  }

  progress.stage("the surface of " + name, from + 0.9 * (to - from), to);
  std::vector<std::pair<std::string, Permutation>> orders;
  for (std::size_t i = 0; i < studied.orders.size(); ++i) {
    orders.emplace_back(studied.record.orders[i].ordering, studied.orders[i].vertices.permutation);
    note_convergence(studied.orders[i].vertices.fiedler, "the vertices of " + name, notes);
  }
  page.meshes.push_back(page_mesh(name, mesh, orders));
  const MeshRecord& record = page.results.meshes.emplace_back(std::move(studied.record));
  return is_matrix ? size_in_words(*stored_matrix(mesh), entry_pattern(mesh))
                   : fmt::format("{} vertices, {} simplices", with_commas(record.vertices),
                                 with_commas(record.tetrahedra));
}

std::string title_of(const Page& page) {
  std::vector<std::string> names;
  for (const PageMesh& mesh : page.meshes) names.push_back(mesh.name);
  return fmt::format("The gain from orders of {}", fmt::join(names, ", "));
}

/// Throws InvalidArgument unless the output's name has the extension of a page: the page would overwrite
/// another file, perhaps a mesh.
void check_name_of_page(const std::string& output, const char* of) {
  const std::string extension = fs::path(output).extension().string();
  if (same_but_for_case(extension, ".html") || same_but_for_case(extension, ".htm")) return;
  throw InvalidArgument("-o " + output + " names the page on " + of + "; give a name that ends in .html");
}

FilePath output_or(const ReportArguments& arguments, const char* usual) {
  return arguments.output.empty() ? FilePath::derived(usual) : FilePath(arguments.output);
}

void report_on_meshes(Console& console, const ReportArguments& arguments) {
  const FilePath file = output_or(arguments, "report.html");
  const std::string output = file.string();
  if (!fs::path(output).extension().empty()) check_name_of_page(output, "meshes");
  (void)OutputFile(file);  // fail before the work if it cannot be written
  Progress progress(!console.quiet());
  Page page;
  page.results.began = timestamp_now();
  page.results.runs = 1;
  page.results.reference = kAsItIs;
  page.results.orderings = orderings_of_report();
  progress.stage("measuring the memory", 0, 0.02);
  page.results.machine = describe_machine();
  Notes notes;
  std::vector<std::string> sizes;
  const double share = 0.96 / static_cast<double>(arguments.inputs.size());
  for (std::size_t i = 0; i < arguments.inputs.size(); ++i) {
    const double from = 0.02 + share * static_cast<double>(i);
    sizes.push_back(add_mesh(page, arguments.inputs[i], arguments, progress, from, from + share, notes));
  }
  std::erase_if(page.results.orderings, [&](const OrderingSpec& ordering) {
    return std::ranges::none_of(page.results.meshes, [&](const MeshRecord& mesh) {
      return find_order(mesh, ordering.name) != nullptr;
    });
  });
  progress.stage("writing " + output, 0.98, 1);
  page.title = title_of(page);
  fill_from_results(page, notes);
  write_page(page, file);

  progress.finish();
  console.warn_of(notes);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const MeshRecord& mesh = page.results.meshes[i];
    console.print("{}: {}\nVerdict: {}", mesh.file, sizes[i], mesh.verdict.empty() ? "none" : mesh.verdict);
  }
  console.print("wrote {}", output);
  console.print_json({{"page", output}, {"results", to_json(page.results)}});
}

/// Returns whether an argument names a study: its folder, or its results.json.
bool is_study(const std::string& input) {
  return fs::is_directory(input) || fs::path(input).extension() == ".json";
}

/// Returns the path of results.json for an argument that names a study.
FilePath results_of(const std::string& input) {
  if (!fs::is_directory(input)) return {input};
  const StudyFolder folder(input);
  if (openfoam::is_case(input))
    throw InputError(input, "is an OpenFOAM case, but a report is on mesh files or on studies",
                     "order its cells with meshorder openfoam " + input);
  if (!fs::exists(folder.results()))
    throw InputError(input, "holds no results.json",
                     "name the folder of a study that `meshorder reproduce` made, or mesh files");
  return folder.file(folder.results());
}

void report_on_study(Console& console, const ReportArguments& arguments) {
  if (!arguments.output.empty())
    throw InvalidArgument(
        "-o is for a report on meshes or two studies; a study's report is written into the study's folder");
  const std::string& input = arguments.inputs.front();
  const fs::path results = results_of(input).path();
  const StudyFolder folder(fs::is_directory(input)     ? fs::path(input)
                           : results.has_parent_path() ? results.parent_path()
                                                       : fs::path("."));
  if (folder.results().filename() != results.filename())
    throw InputError(input, "is not called results.json", "name the folder of the study");
  Progress progress(!console.quiet());
  const WrittenReport report = write_report(folder, [&](std::string_view what, double fraction) {
    progress.stage(std::string(what), fraction, std::min(1.0, fraction + 0.1));
  });
  progress.finish();
  console.warn_of(report.notes);
  auto files = nlohmann::ordered_json::array();
  for (const fs::path& file : report.files) {
    files.push_back(file.string());
    console.print("wrote {}", file.string());
  }
  console.print_json({{"page", folder.page().string()}, {"files", files}});
}

nlohmann::ordered_json saving_json(const Speedup& speedup) {
  return {{"percent", speedup.percent},
          {"low", speedup.low},
          {"high", speedup.high},
          {"beyond_noise", speedup.beyond_noise}};
}

nlohmann::ordered_json savings_json(const ComparedStudy& a, const ComparedStudy& b) {
  auto savings = nlohmann::ordered_json::array();
  for (const meshorder::ComparedOrder& order : compared_orders(a.results, b.results)) {
    nlohmann::ordered_json difference;
    if (order.difference) {
      difference = {{"points", order.difference->points},
                    {"low", order.difference->low},
                    {"high", order.difference->high},
                    {"beyond_noise", order.difference->beyond_noise}};
    }
    savings.push_back({{"scenario", order.scenario},
                       {"ordering", order.ordering},
                       {"a", saving_json(order.a)},
                       {"b", saving_json(order.b)},
                       {"difference", difference}});
  }
  return savings;
}

void compare_studies(Console& console, const ReportArguments& arguments) {
  const FilePath output = output_or(arguments, "comparison.html");
  check_name_of_page(output.path().string(), "two studies");
  const auto read = [](const std::string& input) {
    const FilePath file = results_of(input);
    return ComparedStudy{file.string(), read_results(file)};
  };
  const ComparedStudy a = read(arguments.inputs.front());
  const ComparedStudy b = read(arguments.inputs.back());
  const WrittenComparison written = write_comparison(a, b, output);
  console.print("{}", to_text(written.tables.front()));
  for (const std::string& finding : written.findings) console.print("{}\n", finding);
  auto files = nlohmann::ordered_json::array();
  for (const fs::path& file : written.files) {
    files.push_back(file.string());
    console.print("wrote {}", file.string());
  }
  console.print_json({{"page", output.path().string()}, {"files", files}, {"savings", savings_json(a, b)}});
}

void run(const ReportArguments& arguments) {
  Console console(arguments);
  const auto study = std::find_if(arguments.inputs.begin(), arguments.inputs.end(), is_study);
  if (study == arguments.inputs.end()) return report_on_meshes(console, arguments);
  const bool all = std::all_of(arguments.inputs.begin(), arguments.inputs.end(), is_study);
  if (!all || arguments.inputs.size() > 2)
    throw InvalidArgument(*study + " is a study: report on one by itself, or compare two");
  if (!arguments.option_of_meshes.empty())
    throw InvalidArgument(arguments.option_of_meshes + " is for a report on meshes; " + *study +
                          " is a study, whose measurements exist");
  if (arguments.inputs.size() == 2) return compare_studies(console, arguments);
  report_on_study(console, arguments);
}

}  // namespace

void add_report(CLI::App& subcommand) {
  subcommand.footer(
      "Examples:\n"
      "  meshorder report dragon.veg -o dragon.html   your mesh in its own order and in others, with the\n"
      "                                               gain of each; takes about half a minute\n"
      "  meshorder report results/                    a study: writes its tables, figures and page again\n"
      "  meshorder report mine/ theirs/results.json   two studies: savings of orders on both machines");
  const auto arguments = std::make_shared<ReportArguments>();
  subcommand
      .add_option(
          "INPUT", arguments->inputs,
          "Mesh, matrix or graph files; or one study, or two to compare, each by its folder or results.json")
      ->required()
      ->type_name("MESH… | STUDY [STUDY]");
  subcommand.add_option(
      "-o,--output", arguments->output,
      "File for the page. Default: report.html for meshes, comparison.html for two studies");
  subcommand
      .add_option("--budget", arguments->budget_seconds,
                  "Seconds to spend on running the kernels, for each mesh")
      ->check(positive())
      ->capture_default_str();
  add_ordering_options(subcommand, arguments->ordering);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments, &subcommand] {
    for (const char* const option : {"--budget", "--for", "--seed", "--tolerance"}) {
      if (subcommand.count(option) > 0) arguments->option_of_meshes = option;
    }
    with_threads(arguments->threads, [&] { run(*arguments); });
  });
}

}  // namespace meshorder::command
