// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/stopwatch.hpp"
#include "command.hpp"
#include "compare_report.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "gpu_counts.hpp"
#include "io/format.hpp"
#include "machines.hpp"
#include "matrix_points.hpp"
#include "matrix_report.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include "mesh_files.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "payoff/band.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/machine.hpp"
#include "payoff/product_bench.hpp"
#include "progress.hpp"
#include "reuse_report.hpp"
#include "wording.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

struct CompareArguments : Common {
  std::string input;
  std::string points;
  std::vector<std::string> methods;  ///< empty: the order of auto, and all others
  OrderOptions ordering;
  double budget_seconds = TimingOptions{}.budget_seconds;
  std::string caches;  ///< empty: the machine's, unless prediction takes long
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

ComparedOrder parsed(const std::string& name) {
  ComparedOrder order;
  OrderNames names = order_named(name);
  order.vertices = std::move(names.vertices);
  order.elements = std::move(names.elements);
  return order;
}

/// Returns the orders, the file's own first.
std::vector<ComparedOrder> orders_of(const std::vector<std::string>& names) {
  std::vector<ComparedOrder> orders{parsed("original")};
  for (const std::string& name : names) {
    const ComparedOrder order = parsed(name);
    const bool known = std::any_of(orders.begin(), orders.end(), [&](const ComparedOrder& c) {
      return c.vertices == order.vertices && c.elements == order.elements;
    });
    if (!known) orders.push_back(order);
  }
  return orders;
}

/// Returns the orders of a matrix: of its rows only, as entries keep their places in the file. By default,
/// those that need points are among them only if it has coordinates.
std::vector<ComparedOrder> orders_of_matrix(const Mesh& mesh, const CompareArguments& arguments) {
  std::vector<std::string> names = arguments.methods;
  for (const std::string& name : names) {
    if (name.find('/') != std::string::npos) {
      throw CommandError(
          fmt::format("{}: a matrix or graph has no elements to order; name an order of its rows alone",
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
  std::vector<ComparedOrder> orders = orders_of(names);
  for (ComparedOrder& order : orders) order.elements = "original";
  return orders;
}

/// Times the kernels in all orders and on the band, in interleaved rounds.
///
/// @param entries  pattern of a matrix; empty for a mesh
KernelTable timed(const Mesh& mesh, const EntryPattern& entries, const CsrGraph& graph,
                  const std::vector<ComparedOrder>& orders, const Band& band, KernelSet kernels, int threads,
                  const TimingOptions& options) {
  KernelTable table;
  table.threads = threads;
  const auto prepare = [&](Index i) -> std::unique_ptr<KernelBench> {
    if (i == index_size(orders) && stored_matrix(mesh) != nullptr) {
      auto bench = std::make_unique<ProductBench>(ideal_pattern(entries));
      bench->share(threads);
      return bench;
    }
    if (i == index_size(orders)) return prepare_kernels(kernels, band.mesh, band.graph, threads);
    Mesh ordered = mesh;
    apply_reordering(ordered, orders[i].order);
    auto bench = prepare_kernels(
        kernels, ordered, renumbered(graph, orders[i].order.vertices.permutation.old_to_new()), threads);
    table.redundancy.push_back(bench->redundancy());
    return bench;
  };
  Timings timings = time_orders(index_size(orders) + 1, prepare, options);
  table.orders = std::move(timings.orders);
  table.steadiness = timings.steadiness;
  table.band = table.orders.back();
  table.orders.pop_back();
  return table;
}

/// Counts additions on a graphics processor in an order.
void count_for_gpu(ComparedOrder& order, const Mesh& mesh, const std::vector<GpuLayout>& layouts) {
  if (layouts.empty()) return;
  const Mesh ordered = in_order(mesh, order.order);
  for (const GpuLayout layout : layouts) {
    const std::optional<GpuCost> cost = cost_of_additions(ordered, layout);
    if (!cost) {
      throw CommandError(
          "--gpu-layout: additions are counted for elements with the same number of vertices, at most 255; "
          "this mesh has others or none, leave the option out",
          2);
    }
    order.gpu.push_back(*cost);
  }
}

/// Orders the mesh in all ways, and predicts the cache misses of each if `predicts`. If the user named no
/// orders, an order that equals that of `auto` is left out.
void compute_orders(Comparison& comparison, const Mesh& mesh, const CsrGraph& graph, double graph_seconds,
                    const CompareArguments& arguments, bool predicts, Progress& progress, Notes& notes) {
  const double share = 0.35 / static_cast<double>(comparison.orders.size());
  std::vector<ComparedOrder> computed;
  for (ComparedOrder& c : comparison.orders) {
    const bool is_taken = arguments.methods.empty() && computed.size() > 1 &&
                          computed[1].order.vertices.method.name == c.vertices &&
                          computed[1].order.cells.method.name == c.elements;
    if (is_taken) continue;
    const double from = 0.05 + share * static_cast<double>(computed.size());
    progress.stage("ordering by " + c.vertices + (comparison.is_matrix() ? "" : "/" + c.elements), from,
                   from + share);
    const Stopwatch stopwatch;
    c.order =
        compute_reordering(mesh, graph, {.methods = {c.vertices, c.elements}, .order = arguments.ordering});
    c.seconds = computed.empty() ? 0 : graph_seconds + stopwatch.seconds();
    c.span = edge_span(graph, c.order.vertices.permutation);
    if (predicts) {
      c.reuse = reuse_of_kernels(mesh, graph, c.order.vertices.permutation, c.order.cells.permutation);
      if (arguments.details) c.iterations = iterations_in(graph, c.order.vertices.permutation);
    }
    count_for_gpu(c, mesh, comparison.gpu_layouts);
    note_convergence(c.order.vertices.fiedler, "the vertices by " + c.vertices, notes);
    computed.push_back(std::move(c));
  }
  comparison.orders = std::move(computed);
}

void run(const CompareArguments& arguments) {
  if (arguments.gpu) {
    throw CommandError(
        "--gpu is in the command of the Python package only, which pip installs from the sources of "
        "meshorder, in a virtual environment: venv/bin/pip install . 'cupy-cuda12x[ctk]'; then "
        "venv/bin/meshorder compare --gpu",
        2);
  }
  Console console(arguments);
  Comparison comparison;
  for (const std::string& name : arguments.gpu_layouts)
    comparison.gpu_layouts.push_back(parse_gpu_layout(name));
  comparison.file = arguments.input;
  comparison.workload = arguments.ordering.workload;
  comparison.caches = arguments.caches.empty() ? choose_machine(arguments.machine).model.caches
                                               : parse_caches(arguments.caches);
  comparison.kernel_set = arguments.kernels;
  comparison.orders = orders_of(arguments.methods.empty() ? default_methods() : arguments.methods);
  confine({.meshes = {arguments.input}, .others = named_files(arguments.points)});
  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.05);
  Notes notes;
  Mesh mesh = read_to_work_on(arguments.input, notes, kBytesToMeasure * (comparison.orders.size() + 2));
  take_points(mesh, arguments.input, arguments.points);
  const StoredMatrix* const stored = stored_matrix(mesh);
  if (stored != nullptr && !comparison.gpu_layouts.empty()) {
    throw CommandError(
        "--gpu-layout: a matrix or graph has no elements; `meshorder info --gpu` counts its products", 2);
  }
  if (stored != nullptr) comparison.orders = orders_of_matrix(mesh, arguments);
  const EntryPattern entries = stored != nullptr ? entry_pattern(mesh) : EntryPattern{};
  comparison.kernels_run = kernels_of(mesh);
  comparison.size = stored != nullptr ? size_in_words(*stored, entries)
                                      : fmt::format("{} vertices, {}", with_commas(mesh.vertex_count()),
                                                    cells_in_words(mesh));
  mesh.cell_blocks.clear();  // orders are compared, not the layout of a file
  const Stopwatch building_graph;
  const CsrGraph graph = vertex_graph(mesh);
  const bool predicts =
      (arguments.details || arguments.json) && (!arguments.caches.empty() || is_quick_to_predict(mesh));
  compute_orders(comparison, mesh, graph, building_graph.seconds(), arguments, predicts, progress, notes);

  progress.stage("running kernels", 0.4, 1);
  TimingOptions timing;
  timing.budget_seconds = arguments.budget_seconds;
  const Band band = ideal_band(mesh, graph);
  comparison.band_span = edge_span(band.graph, Permutation::identity(band.graph.size()));
  std::vector<int> thread_counts{1};
  if (arguments.threads > 1) thread_counts.push_back(arguments.threads);
  timing.budget_seconds /= static_cast<double>(thread_counts.size());
  for (const int threads : thread_counts) {
    timing.processor_time = threads == 1;
    comparison.kernels.push_back(
        timed(mesh, entries, graph, comparison.orders, band, arguments.kernels, threads, timing));
  }

  progress.finish();
  for (const KernelTable& table : comparison.kernels) {
    if (std::string doubt = reason_to_doubt(table.steadiness); !doubt.empty()) {
      notes.push_back(fmt::format("on {} thread{}: {}", table.threads, table.threads == 1 ? "" : "s", doubt));
    }
  }
  console.warn_of(notes);
  print_comparison(console, comparison);
  if (arguments.details) print_comparison_details(console, comparison);
  nlohmann::ordered_json result{{"file", arguments.input},
                                {"vertices", mesh.vertex_count()},
                                {"cells", cells_by_type(mesh)},
                                {"reference", "original"}};
  result.update(to_json(comparison));
  console.print_json(result);
}

}  // namespace

void add_compare(CLI::App& subcommand) {
  subcommand.description(
      "Say which order of a mesh is best on this machine: run kernels in the file's own order and others.\n"
      "With --threads N, N > 1, they run on one thread and then on N.");
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
      "Run kernels on this machine's GPU instead; in the command of the Python package, with\n"
      "CuPy. Other options are then --methods, --threads, --json and --quiet");
  subcommand
      .add_option("--gpu-layout", arguments->gpu_layouts,
                  "Also count what atomic additions cost on a graphics processor: packed, apart, padded,\n"
                  "patches or gathered, separated by commas")
      ->delimiter(',')
      ->type_name("LAYOUT");
  subcommand.add_option("--budget", arguments->budget_seconds, "Seconds to spend on running the kernels")
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
