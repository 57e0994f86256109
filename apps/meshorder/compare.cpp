// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "compare_report.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "gpu_counts.hpp"
#include "io/format.hpp"
#include "machines.hpp"
#include "matrix_points.hpp"
#include "matrix_report.hpp"
#include "mesh/stored_matrix.hpp"
#include "ordering/method.hpp"
#include "payoff/machine.hpp"
#include "progress.hpp"
#include "wording.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

struct CompareArguments : Common {
  std::string input;
  std::string points;
  std::vector<std::string> methods;  ///< empty: `default_methods()`
  OrderOptions ordering;
  double budget_seconds = TimingOptions{}.budget_seconds;
  std::string caches;  ///< empty: caches of `machine`, and no misses for large meshes
  std::string machine;
  KernelSet kernels = KernelSet::plain;
  bool details = false;
  bool gpu = false;
  std::vector<std::string> gpu_layouts;
};

std::vector<std::string> default_methods() {
  std::vector<std::string> names{"auto"};
  for (const MethodInfo& method : vertex_methods()) {
    if (method.name != "auto" && method.name != "scrambled") names.emplace_back(method.name);
  }
  names.insert(std::find(names.begin(), names.end(), "fiedler") + 1, "fiedler/fiedler");
  return names;
}

std::vector<std::string> names_of(const CompareArguments& arguments) {
  return arguments.methods.empty() ? default_methods() : arguments.methods;
}

std::vector<MeshMethods> methods_of(const std::vector<std::string>& names) {
  std::vector<MeshMethods> methods;
  methods.reserve(names.size());
  for (const std::string& name : names) methods.push_back(order_named(name));
  return methods;
}

/// Returns the methods for the rows of a matrix; its entries stay in the file's order. Without coordinates,
/// the default methods are only those that need none.
std::vector<MeshMethods> methods_of_matrix(const Mesh& mesh, const CompareArguments& arguments) {
  std::vector<std::string> names = arguments.methods;
  for (const std::string& name : names) {
    if (name.find('/') != std::string::npos) {
      throw CommandError(
          fmt::format("{}: a matrix or graph has no elements to order; give only the order of its rows",
                      name),
          2);
    }
    require_points(mesh, arguments.input, name, "original");
  }
  if (names.empty()) {
    for (std::string& name : default_methods()) {
      const bool of_rows = name.find('/') == std::string::npos;
      if (of_rows && (has_places(mesh) || !needs_points(vertex_methods(), name)))
        names.push_back(std::move(name));
    }
  }
  std::vector<MeshMethods> methods = methods_of(names);
  for (MeshMethods& order : methods) order.elements = "original";
  return methods;
}

/// Counts additions on a graphics processor in each order, for each layout.
void count_for_gpu(ComparisonReport& report, const Mesh& mesh) {
  for (const ComparedMeshOrder& c : report.orders) {
    std::vector<GpuCost>& costs = report.gpu.emplace_back();
    const Mesh ordered = in_order(mesh, c.order);
    for (const GpuLayout layout : report.gpu_layouts) costs.push_back(*cost_of_additions(ordered, layout));
  }
}

/// Returns the comparison of the orders that the arguments name.
ComparisonReport compared(const CompareArguments& arguments, const Mesh& mesh, Progress& progress,
                          std::vector<GpuLayout> layouts) {
  const StoredMatrix* const stored = stored_matrix(mesh);
  ComparisonReport report{compare_orders(
      mesh,
      {.methods = stored != nullptr ? methods_of_matrix(mesh, arguments) : methods_of(names_of(arguments)),
       .only_new = arguments.methods.empty(),
       .ordering = arguments.ordering,
       .kernels = arguments.kernels,
       .threads = arguments.threads,
       .budget_seconds = arguments.budget_seconds,
       .reuse = arguments.details || arguments.json,
       .reuse_of_large = !arguments.caches.empty(),
       .iterations = arguments.details,
       .begins = [&](const std::string& stage, double from, double to) {
         progress.stage(stage, from, to);
       }})};
  report.file = arguments.input;
  report.size = stored != nullptr
                    ? size_in_words(*stored, entry_pattern(mesh))
                    : fmt::format("{} vertices, {}", with_commas(mesh.vertex_count()), cells_in_words(mesh));
  report.gpu_layouts = std::move(layouts);
  if (!report.gpu_layouts.empty()) count_for_gpu(report, mesh);
  return report;
}

void run(const CompareArguments& arguments) {
  if (arguments.gpu) {
    throw CommandError(
        "--gpu is in the command of the Python package only; install it from the sources of meshorder in a "
        "virtual environment: venv/bin/pip install . 'cupy-cuda12x[ctk]'; then run venv/bin/meshorder "
        "compare --gpu",
        2);
  }
  if (arguments.ordering.workload == Workload::gpu) {
    throw CommandError(
        "--for gpu: the kernels run on this machine's processor; `meshorder info --gpu` counts what kernels "
        "cost on a graphics processor, and --gpu-layout padded counts the additions of each order",
        2);
  }
  Console console(arguments);
  std::vector<GpuLayout> layouts;
  for (const std::string& name : arguments.gpu_layouts) layouts.push_back(parse_gpu_layout(name));
  const Caches caches = arguments.caches.empty() ? choose_machine(arguments.machine).model.caches
                                                 : parse_caches(arguments.caches);
  const std::size_t orders = names_of(arguments).size();
  confine({.meshes = {arguments.input}, .others = named_files(arguments.points)});
  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.05);
  Notes notes;
  Mesh mesh = read_input(arguments.input, notes, kBytesToMeasure * (orders + 3));
  take_points(mesh, arguments.input, arguments.points);
  if (!layouts.empty() && stored_matrix(mesh) != nullptr) {
    throw CommandError(
        "--gpu-layout: a matrix or graph has no elements; `meshorder info --gpu` counts its products", 2);
  }
  if (!layouts.empty() && !counts_additions(mesh)) {
    throw CommandError(
        "--gpu-layout: additions are counted for elements with the same number of vertices, at most 255; "
        "this mesh has other elements or none; leave the option out",
        2);
  }
  mesh.cell_blocks.clear();  // without the file's blocks, which would restrict the orders
  ComparisonReport report = compared(arguments, mesh, progress, std::move(layouts));
  report.caches = caches;
  progress.finish();
  for (const ComparedMeshOrder& c : report.orders)
    note_convergence(c.order.vertices.fiedler, "the vertices by " + c.asked.vertices, notes);
  for (const KernelTable& table : report.kernels) {
    if (std::string doubt = reason_to_doubt(table.steadiness); !doubt.empty()) {
      notes.push_back(fmt::format("on {} thread{}: {}", table.threads, table.threads == 1 ? "" : "s", doubt));
    }
  }
  console.warn_of(notes);
  print_comparison(console, report);
  if (arguments.details) print_comparison_details(console, report);
  nlohmann::ordered_json result{{"file", arguments.input},
                                {"vertices", mesh.vertex_count()},
                                {"cells", cells_by_type(mesh)},
                                {"reference", "original"}};
  result.update(to_json(report));
  console.print_json(result);
}

}  // namespace

void add_compare(CLI::App& subcommand) {
  subcommand.description(
      "Run kernels on a mesh in its own order and in others, and say which order is best on this machine.\n"
      "With --threads N, N > 1, the kernels run on one thread and then on N.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder compare dragon.veg\n"
      "  meshorder compare dragon.veg --methods hilbert,fiedler,metis-nd --details");
  const auto arguments = std::make_shared<CompareArguments>();
  subcommand.add_option("MESH", arguments->input, "Mesh, matrix or graph file")->required();
  add_points_option(subcommand, arguments->points);
  subcommand
      .add_option(
          "--methods", arguments->methods,
          "Orders to compare with the file's own, VERTICES or VERTICES/ELEMENTS, separated by commas\n"
          "(default: auto, all methods for vertices except scrambled, and fiedler/fiedler)")
      ->delimiter(',');
  subcommand.add_flag("--details", arguments->details,
                      "Also show edge spans, cache misses and milliseconds of each order");
  subcommand.add_flag(
      "--gpu", arguments->gpu,
      "Run kernels on this machine's GPU instead. This needs the command of the Python package,\n"
      "and CuPy. It takes no other options than --methods, --threads, --json and --quiet");
  subcommand
      .add_option("--gpu-layout", arguments->gpu_layouts,
                  "Also count the cost of atomic additions on a graphics processor: packed, apart, padded,\n"
                  "patches or gathered, separated by commas")
      ->delimiter(',')
      ->type_name("LAYOUT");
  subcommand
      .add_option("--budget", arguments->budget_seconds,
                  "Seconds to spend on computing the orders and on running the kernels, which run at least\n"
                  "twice in each order that is not slow")
      ->check(positive())
      ->capture_default_str();
  add_cache_option(subcommand, arguments->caches);
  add_machine_option(subcommand, arguments->machine);
  add_kernels_option(subcommand, arguments->kernels);
  add_ordering_options(subcommand, arguments->ordering);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
