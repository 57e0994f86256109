// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "command.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "graph/traversal.hpp"
#include "io/format.hpp"
#include "machines.hpp"
#include "mesh/degenerate.hpp"
#include "mesh/graphs.hpp"
#include "mesh_files.hpp"
#include "metrics/edge_span.hpp"
#include "payoff/advice.hpp"
#include "payoff/machine.hpp"
#include "progress.hpp"
#include "reuse_report.hpp"
#include "verdict.hpp"
#include "wording.hpp"
#include <meshorder/mesh.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

struct InfoArguments : Common {
  std::string input;
  std::string caches;  ///< empty: the machine's, unless that takes long
  std::string machine;
  bool all_threads = false;
  bool measure = false;
  KernelSet kernels = KernelSet::plain;
};

/// Seconds from the command's start until --measure is done, for meshes of up to about 300 thousand vertices.
constexpr double kMeasureWithin = 3.8;
/// Simplices up to which times are predicted without being asked, in a few seconds a million vertices.
constexpr Offset kMaxPredicted = 100'000'000;
/// Simplices above which there is no time to measure a second order.
constexpr Offset kMaxOfTwoOrders = 500'000;

/// Whether there is something for the kernels to compute: points are no elements.
bool has_elements(SimplicesRef simplices) { return simplices.size() > 0; }

/// Whether times are predicted: unless --cache is given, only where this takes seconds.
bool is_predicted(const InfoArguments& arguments, SimplicesRef simplices) {
  return has_elements(simplices) && (simplices.size() <= kMaxPredicted || !arguments.caches.empty());
}

/// As of `reuse_of`: all lines are followed for the caches that are asked for.
int halvings_of(const InfoArguments& arguments, SimplicesRef simplices) {
  return arguments.caches.empty() ? halvings_for(simplices.size()) : 0;
}

/// Returns what reordering is worth; nothing for a mesh without elements, nor for a large one unless --cache
/// or --measure is given.
std::optional<Advice> advice_on(const InfoArguments& arguments, const Mesh& mesh, const CsrGraph& graph,
                                double graph_seconds, SimplicesRef simplices,
                                const std::optional<KernelReuse>& reuse, const MachineChoice& machine,
                                const Stopwatch& since_start) {
  AdviceOptions options;
  options.machine = machine;
  options.describe = false;
  if (arguments.all_threads) options.threads = thread_count();
  if (!arguments.caches.empty()) options.caches = parse_caches(arguments.caches);
  options.graph_seconds = graph_seconds;
  if (arguments.caches.empty()) options.reuse_as_is = reuse;
  options.kernels = arguments.kernels;
  options.predict = arguments.kernels == KernelSet::plain && is_predicted(arguments, simplices) &&
                    machine.model.threads == options.threads;
  const bool is_measured = arguments.measure && has_elements(simplices);
  if (!options.predict && !is_measured) return std::nullopt;
  if (is_measured) {
    options.measure_within = kMeasureWithin - since_start.seconds();
    options.for_springs_too = simplices.size() <= kMaxOfTwoOrders;
    if (simplices.size() > kMaxOfTwoOrders) options.halvings = 5;
  }
  return advise(mesh, graph, options);
}

/// Returns the reuse of the mesh in its order; nothing for a large mesh unless --cache is given, nor when
/// measuring leaves no time for it.
std::optional<KernelReuse> reuse_of(const InfoArguments& arguments, const CsrGraph& graph,
                                    SimplicesRef simplices) {
  const Offset most = arguments.measure ? kMaxOfTwoOrders : kMaxPredicted;
  if (arguments.caches.empty() && simplices.size() > most) return std::nullopt;
  return reuse_of_kernels(graph, simplices, halvings_of(arguments, simplices));
}

/// Whether the points of a mesh differ: those of a matrix or a graph are all at the origin.
bool has_places(const Mesh& mesh) {
  return std::any_of(mesh.points.begin(), mesh.points.end(),
                     [&](const Point& point) { return point != mesh.points.front(); });
}

/// Prints a bar for each power of two, in proportion to its number of edges.
void print_histogram(const Console& console, const std::vector<Offset>& bins) {
  constexpr double kWidth = 50;
  const Offset largest = *std::max_element(bins.begin(), bins.end());
  console.print("\nEdges by span");
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const long length = std::lround(kWidth * static_cast<double>(bins[k]) / static_cast<double>(largest));
    std::string bar;
    for (long i = 0; i < length; ++i) bar += "█";
    if (length == 0 && bins[k] > 0) bar = "▏";
    console.print("{:>13} {:>12}  {}", "from " + with_commas(1LL << k), with_commas(bins[k]), bar);
  }
}

nlohmann::ordered_json attachments(const Mesh& mesh) {
  auto data = nlohmann::ordered_json::array();
  for (const DataArray& array : mesh.data) {
    data.push_back({{"name", array.name},
                    {"on", to_string(array.association)},
                    {"components", array.components},
                    {"rows", row_count(array)}});
  }
  auto sets = nlohmann::ordered_json::array();
  for (const EntitySet& set : mesh.sets) {
    sets.push_back({{"name", set.name}, {"on", to_string(set.association)}, {"members", set.members.size()}});
  }
  return {{"data", data}, {"sets", sets}};
}

void print_attachments(const Console& console, const Mesh& mesh) {
  const auto list = [&](Association association) {
    std::vector<std::string> names;
    for (const DataArray& array : mesh.data) {
      if (array.association == association) names.push_back(visible(array.name));
    }
    for (const EntitySet& set : mesh.sets) {
      if (set.association == association) names.push_back("set " + visible(set.name));
    }
    return join(names);
  };
  for (const auto& [association, title] :
       {std::pair(Association::vertices, "on vertices"), std::pair(Association::cells, "on cells")}) {
    const std::string names = list(association);
    if (!names.empty()) console.print("{:<12} {}", title, names);
  }
}

void run(const InfoArguments& arguments) {
  Console console(arguments);
  Notes notes;
  const Stopwatch since_start;
  // refused before anything takes time
  if (!arguments.caches.empty()) (void)parse_caches(arguments.caches);
  if (arguments.kernels == KernelSet::tuned && !arguments.measure) {
    throw CommandError("--kernels tuned: these are not predicted; give --measure, too", 2);
  }
  MachineChoice machine = choose_machine(arguments.machine, arguments.all_threads && !arguments.measure);
  confine({.meshes = {arguments.input}});
  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.3);
  const Mesh mesh =
      read_to_work_on(arguments.input, notes, arguments.measure ? 3 * kBytesToMeasure : kBytesToPredict);

  const CellSimplices simplices(mesh);
  // who asks for measured times does not wait for what they would be predicted by
  if (!arguments.measure && is_predicted(arguments, simplices)) {
    machine = calibrated(std::move(machine), arguments.all_threads, progress, console.quiet(), notes);
  }
  const Caches caches = arguments.caches.empty() ? machine.model.caches : parse_caches(arguments.caches);
  progress.stage("measuring", 0.3, 0.6);
  const Stopwatch building_graph;
  const CsrGraph graph = vertex_graph(mesh);
  const double graph_seconds = building_graph.seconds();
  const Permutation order = Permutation::identity(mesh.vertex_count());
  EdgeSpan span;
  Offset envelope = 0;
  std::vector<Offset> histogram;
  std::optional<KernelReuse> reuse;
  Offset components = 0;
  Offset isolated = 0;
  Offset degenerate = 0;
  const std::array<std::function<void()>, 4> looks{
      [&] { reuse = reuse_of(arguments, graph, simplices); },
      [&] {
        const ComponentCounts counts = component_counts(graph);
        components = counts.components;
        isolated = counts.isolated;
      },
      [&] {
        span = edge_span(graph, order);
        envelope = profile(graph, order);
        histogram = span_histogram_log2(graph, order);
      },
      [&] { degenerate = std::ssize(degenerate_cells(mesh.cells)); }};
  take_turns(index_size(looks), [&](Index turn) { looks[turn](); });
  const Offset connected = components - isolated;
  progress.stage(arguments.measure ? "running kernels" : "predicting", 0.6, 1);
  const std::optional<Advice> advice =
      advice_on(arguments, mesh, graph, graph_seconds, simplices, reuse, machine, since_start);

  progress.finish();
  if (advice && !advice->doubt.empty()) notes.push_back(advice->doubt);
  console.warn_of(notes);
  const std::string_view format = format_named(mesh.format).name;
  console.print("{}, {}", arguments.input, format);
  console.print("{:<12} {} {}", "vertices", with_commas(mesh.vertex_count()),
                has_places(mesh) ? fmt::format("in {} dimensions", mesh.dimension) : "without coordinates");
  console.print("{:<12} {}", "cells", cells_in_words(mesh));
  print_attachments(console, mesh);
  console.print("{:<12} {} edges, {} {}{}", "graph", with_commas(graph.edge_count()), with_commas(connected),
                connected == 1 ? "component" : "components",
                isolated > 0 ? fmt::format(", {} unused vertices", with_commas(isolated)) : "");
  if (degenerate > 0)
    console.print("{:<12} {} cells use a vertex twice", "degenerate", with_commas(degenerate));
  console.print("{:<12} mean {:.1f}, largest {}, mean log2 {:.2f} (a random order: mean {:.0f})", "edge span",
                span.mean, with_commas(span.max), span.mean_log2, (mesh.vertex_count() + 1) / 3.0);
  console.print("{:<12} {}", "bandwidth", with_commas(span.max));
  console.print("{:<12} {}", "profile", with_commas(envelope));
  if (!histogram.empty()) print_histogram(console, histogram);
  if (reuse) {
    const int halvings = halvings_of(arguments, simplices);
    console.print("\nPredicted for each run of a kernel{}\n{}",
                  halvings > 0 ? fmt::format(", estimated from 1/{} of the lines", 1 << halvings) : "",
                  kReuseLegend);
    console.print("{:<14}{}", "", reuse_header(caches));
    for (std::size_t k = 0; k < kKernels.size(); ++k)
      console.print("{:<14}{}", kKernelTitles[k], reuse_cells((*reuse)[k], caches));
  } else if (arguments.measure) {
    console.warn(
        "not shown, to save time: cache misses and an order for springs only; see meshorder compare");
  } else {
    console.warn(
        "not shown, to save time on a large mesh: cache misses and the verdict; --cache this predicts them, "
        "--measure runs the kernels");
  }
  if (advice) print_verdict(console, *advice);

  nlohmann::ordered_json result{
      {"file", arguments.input},
      {"format", format},
      {"vertices", mesh.vertex_count()},
      {"dimension", mesh.dimension},
      {"cells", cells_by_type(mesh)},
      {"degenerate_cells", degenerate},
      {"graph", {{"edges", graph.edge_count()}, {"components", connected}, {"isolated_vertices", isolated}}},
      {"edge_span", to_json(span)},
      {"bandwidth", span.max},
      {"profile", envelope},
      {"span_histogram_log2", histogram}};
  if (reuse) result.update({{"caches", caches.level_bytes}, {"reuse", to_json(*reuse, caches)}});
  result["verdict"] = advice ? to_json(*advice) : nullptr;
  result.update(attachments(mesh));
  console.print_json(result);
}

}  // namespace

void add_info(CLI::App& subcommand) {
  subcommand.description("Show what a mesh file holds and whether its order is good.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder info dragon.veg\n"
      "  meshorder info dragon.veg --measure");
  const auto arguments = std::make_shared<InfoArguments>();
  subcommand.add_option("MESH", arguments->input, "Mesh file")->required();
  add_cache_option(subcommand, arguments->caches);
  add_machine_option(subcommand, arguments->machine);
  add_all_threads_option(subcommand, arguments->all_threads);
  subcommand.add_flag(
      "--measure", arguments->measure,
      "Run the kernels for a few seconds, in the mesh's order and in a better one, instead of\n"
      "predicting the gain");
  add_kernels_option(subcommand, arguments->kernels);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments, std::string(kQuiet) + ": status 0 says that the file can be read");
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
