// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "command.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "gpu_counts.hpp"
#include "graph/traversal.hpp"
#include "io/format.hpp"
#include "machines.hpp"
#include "matrix_points.hpp"
#include "matrix_report.hpp"
#include "mesh/cells.hpp"
#include "mesh/graphs.hpp"
#include "mesh/stored_matrix.hpp"
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
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

struct InfoArguments : Common {
  std::string input;
  std::string points;
  std::string caches;  ///< empty: caches of `machine`, and no predictions for large meshes
  std::string machine;
  bool all_threads = false;
  bool measure = false;
  bool predict = false;
  bool details = false;
  bool gpu = false;
  std::string card;  ///< empty: no times
  KernelSet kernels = KernelSet::plain;
};

/// Seconds from the start of the command to the end of --measure, for up to about 300 thousand vertices.
constexpr double kMeasureWithin = 3.8;
/// Seconds until the end of a quick measurement, for meshes of up to `kMaxQuick` simplices and matrices of up
/// to `kMaxQuickEntries` entries.
constexpr double kMeasureQuicklyWithin = 1.0;
constexpr Offset kMaxQuick = 250'000;
constexpr Offset kMaxQuickEntries = 1'000'000;
/// Bytes of the smallest first-level cache of today's processors.
constexpr Offset kFirstCache = 32 * 1024;
/// Largest number of simplices for which times are predicted by default. A prediction takes seconds per
/// million vertices.
constexpr Offset kMaxPredicted = 100'000'000;
/// Largest number of simplices for which there is time to measure a second order.
constexpr Offset kMaxOfTwoOrders = 500'000;

/// Returns whether the mesh has elements, which the kernels need; points are not elements.
bool has_elements(SimplicesRef simplices) { return simplices.size() > 0; }

/// Returns whether times are predicted: for 1 to `kMaxPredicted` simplices; with --cache, also for more.
bool is_predicted(const InfoArguments& arguments, SimplicesRef simplices) {
  return has_elements(simplices) && (simplices.size() <= kMaxPredicted || !arguments.caches.empty());
}

/// Returns whether the matrix of a graph and two vectors fit in the first cache; all orders are then equally
/// fast.
bool fits_in_first_cache(const CsrGraph& graph) {
  constexpr Offset kBytesPerEntry = sizeof(double) + sizeof(Index);
  const Offset entries = std::ssize(graph.neighbours) + graph.size();
  return entries * kBytesPerEntry + Offset{2} * graph.size() * sizeof(double) <= kFirstCache;
}

/// How the gain is determined.
enum class By : std::uint8_t { prediction, quick_measurement, measurement, counts };

/// Returns how the gain is determined: as the user requests; by default, by a short measurement for small
/// meshes and by a prediction for large ones.
By judged_by(const InfoArguments& arguments, const Mesh& mesh, SimplicesRef simplices,
             const MachineChoice& machine) {
  if (arguments.gpu) return By::counts;
  if (arguments.measure) return By::measurement;
  const bool asks_for_times = arguments.predict || !arguments.machine.empty() || !arguments.caches.empty() ||
                              (machine.name != "this" && !machine.stands_in);
  const Offset most = stored_matrix(mesh) != nullptr ? kMaxQuickEntries : kMaxQuick;
  return asks_for_times || simplices.size() > most ? By::prediction : By::quick_measurement;
}

/// Returns `halvings` for `reuse_of_kernels`: 0 (all cache lines) if --cache is given.
int halvings_of(const InfoArguments& arguments, SimplicesRef simplices) {
  return arguments.caches.empty() ? halvings_for(simplices.size()) : 0;
}

/// Returns the gain of reordering. Returns nothing if it is neither predicted nor measured, or if a quick
/// measurement would run on data that fit in the first cache.
std::optional<Advice> advice_on(const InfoArguments& arguments, const Mesh& mesh, const CsrGraph& graph,
                                double graph_seconds, SimplicesRef simplices,
                                const std::optional<KernelReuse>& reuse, const MachineChoice& machine, By by,
                                const Stopwatch& since_start) {
  AdviceOptions options;
  options.machine = machine;
  options.describe = false;
  if (arguments.all_threads) options.threads = thread_count();
  if (!arguments.caches.empty()) options.caches = parse_caches(arguments.caches);
  options.graph_seconds = graph_seconds;
  if (arguments.caches.empty()) options.reuse_as_is = reuse;
  options.kernels = arguments.kernels;
  options.predict = by != By::quick_measurement && arguments.kernels == KernelSet::plain &&
                    is_predicted(arguments, simplices) && machine.model.threads == options.threads;
  options.predict_in_doubt =
      arguments.kernels == KernelSet::plain && machine.model.threads == options.threads;
  const bool is_measured = by != By::prediction && has_elements(simplices);
  if (!options.predict && !is_measured) return std::nullopt;
  if (by == By::quick_measurement && fits_in_first_cache(graph)) return std::nullopt;
  if (is_measured) {
    options.measure_within =
        (by == By::measurement ? kMeasureWithin : kMeasureQuicklyWithin) - since_start.seconds();
    options.for_springs_too = simplices.size() <= kMaxOfTwoOrders;
    if (simplices.size() > kMaxOfTwoOrders) options.halvings = 5;
  }
  return advise(mesh, graph, options);
}

/// Returns the reuse of the mesh in its order. Without --cache, returns nothing for more than `kMaxPredicted`
/// simplices or, with --measure, more than `kMaxOfTwoOrders`.
///
/// @param pattern  of a matrix; null for other meshes
std::optional<KernelReuse> reuse_of(const InfoArguments& arguments, const CsrGraph& graph,
                                    SimplicesRef simplices, const EntryPattern* pattern) {
  const Offset most = arguments.measure ? kMaxOfTwoOrders : kMaxPredicted;
  if (arguments.caches.empty() && simplices.size() > most) return std::nullopt;
  const int halvings = halvings_of(arguments, simplices);
  return pattern != nullptr ? reuse_of_kernels(*pattern, halvings)
                            : reuse_of_kernels(graph, simplices, halvings);
}

/// Prints a bar for each power of two, in proportion to its number of edges or entries.
void print_histogram(const Console& console, std::string_view title, const std::vector<Offset>& bins) {
  if (bins.empty()) return;
  constexpr int kWidth = 50;
  const auto largest = static_cast<double>(*std::max_element(bins.begin(), bins.end()));
  console.print("\n{}", title);
  for (std::size_t k = 0; k < bins.size(); ++k) {
    console.print("{:>13} {:>12}  {}", "from " + with_commas(1LL << k), with_commas(bins[k]),
                  bins[k] > 0 ? bar(static_cast<double>(bins[k]) / largest, kWidth) : "");
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

/// Prints the contents of a mesh and the distances of its neighbours.
void print_mesh_facts(const Console& console, const Mesh& mesh, Offset edges, const GraphFacts& facts,
                      Offset degenerate) {
  const Index isolated = facts.components.isolated;
  const Index connected = facts.components.components - isolated;
  console.print("{:<12} {} {}", "vertices", with_commas(mesh.vertex_count()),
                has_places(mesh) ? fmt::format("in {} dimensions", mesh.dimension) : "without coordinates");
  console.print("{:<12} {}", "cells", cells_in_words(mesh));
  print_attachments(console, mesh, "on vertices", "on cells");
  console.print("{:<12} {} edges, {} {}{}", "graph", with_commas(edges), with_commas(connected),
                connected == 1 ? "component" : "components",
                isolated > 0 ? fmt::format(", {} unused vertices", with_commas(isolated)) : "");
  if (degenerate > 0)
    console.print("{:<12} {} cells use a vertex twice", "degenerate", with_commas(degenerate));
  console.print("{:<12} mean {:.1f}, largest {}, mean log2 {:.2f} (a random order: mean {:.0f})", "edge span",
                facts.span.mean, with_commas(facts.span.max), facts.span.mean_log2,
                (mesh.vertex_count() + 1) / 3.0);
  console.print("{:<12} {}", "bandwidth", with_commas(facts.span.max));
  console.print("{:<12} {}", "profile", with_commas(facts.profile));
}

/// The report of `info` on a mesh.
struct Findings {
  std::string_view format;
  const StoredMatrix* stored = nullptr;  ///< set for a matrix or graph
  MatrixReport matrix;                   ///< filled for a matrix or graph
  CsrGraph graph;
  double graph_seconds = 0;
  GraphFacts facts;
  Offset degenerate = 0;
  bool has_elements = true;
  std::optional<KernelReuse> reuse;
  int halvings = 0;  ///< `reuse` is estimated from 2^-halvings of the cache lines
  Caches caches;
  std::optional<Advice> advice;
  std::optional<GpuReport> gpu;  ///< in place of advice
};

/// Counts the contents of a mesh, and its cache misses if they are shown or needed for a prediction.
Findings counted(const InfoArguments& arguments, const Mesh& mesh, SimplicesRef simplices, By by) {
  Findings found;
  found.format = format_named(mesh.format).name;
  found.has_elements = has_elements(simplices);
  found.halvings = halvings_of(arguments, simplices);
  found.stored = stored_matrix(mesh);
  const Stopwatch building_graph;
  found.graph = vertex_graph(mesh);
  found.graph_seconds = building_graph.seconds();
  if (found.stored != nullptr) found.matrix.pattern = entry_pattern(mesh);
  const Permutation order = Permutation::identity(mesh.vertex_count());
  const std::array<std::function<void()>, 5> looks{
      [&] {
        if (by == By::counts) return;
        if (by == By::quick_measurement && !arguments.details && !arguments.json) return;
        found.reuse = reuse_of(arguments, found.graph, simplices,
                               found.stored != nullptr ? &found.matrix.pattern : nullptr);
      },
      [&] { found.facts.components = component_counts(found.graph); },
      [&] {
        found.facts.span = edge_span(found.graph, order);
        found.facts.profile = profile(found.graph, order);
        found.facts.histogram = span_histogram_log2(found.graph, order);
      },
      [&] { found.degenerate = std::ssize(degenerate_cells(mesh.cells)); },
      [&] { found.matrix.facts = facts_of(found.matrix.pattern); }};
  take_turns(index_size(looks), [&](Index turn) { looks[turn](); });
  return found;
}

/// Prints the histogram and the cache misses.
void print_details(const Console& console, const Mesh& mesh, const Findings& found) {
  const bool is_matrix = found.stored != nullptr;
  if (!is_matrix) {
    print_histogram(console, "Edges by span", found.facts.histogram);
  } else if (found.stored->is_graph) {
    print_histogram(console, "Edges by the distance of their ends", found.facts.histogram);
  } else {
    print_histogram(console, "Entries by their distance from the diagonal",
                    found.matrix.facts.histogram_log2);
  }
  if (!found.reuse) return;
  console.print(
      "\nPredicted for each {}{}\n{}", is_matrix ? "product" : "run of a kernel",
      found.halvings > 0 ? fmt::format(", estimated from 1/{} of the lines", 1 << found.halvings) : "",
      kReuseLegend);
  console.print("{:<14}{}", "", reuse_header(found.caches));
  for (std::size_t k = 0; k < kernels_of(mesh).size(); ++k) {
    console.print("{:<14}{}", is_matrix ? kProduct : kKernelTitles[k],
                  reuse_cells((*found.reuse)[k], found.caches));
  }
}

/// Prints the gain of the best other order, and the command that makes it.
void print_verdict(const Console& console, const InfoArguments& arguments, const Findings& found) {
  const std::optional<Advice>& advice = found.advice;
  if (found.gpu) {
    console.print("{}: {}", arguments.input, to_string(*found.gpu));
    print_next(console, *found.gpu, arguments.input);
    return;
  }
  const char* const without_advice =
      !found.has_elements && found.stored != nullptr
          ? "nothing to gain: no entry joins two rows, so every order is equally good"
      : !found.has_elements ? "nothing to compute: the mesh has no elements"
      : fits_in_first_cache(found.graph)
          ? "nothing to gain: its data fit in a processor's first cache, in any order"
          : "too large to be judged by default; --measure runs the kernels, and --cache this predicts cache "
            "misses and times";
  if (!advice) return console.print("{}: {}", arguments.input, without_advice);
  console.print("{}", arguments.input);
  console.print("{:<12} {}", "order", grade_in_words(*advice, found.graph.size()));
  console.print("{:<12} {}", "gain", to_string(*advice));
  print_next(console, *advice, arguments.input);
}

/// Prints the verdict, and then the contents of the mesh.
void print_findings(const Console& console, const InfoArguments& arguments, const Mesh& mesh,
                    const Findings& found) {
  print_verdict(console, arguments, found);
  console.print("\n{:<12} {}", "format", found.format);
  if (found.stored != nullptr) {
    print_matrix(console, mesh, found.matrix, found.facts);
  } else {
    print_mesh_facts(console, mesh, found.graph.edge_count(), found.facts, found.degenerate);
  }
  if (found.advice) print_times(console, *found.advice);
  if (found.gpu) print_counts(console, *found.gpu);
  if (arguments.details) print_details(console, mesh, found);
}

nlohmann::ordered_json info_json(const InfoArguments& arguments, const Mesh& mesh, const Findings& found) {
  const GraphFacts& facts = found.facts;
  nlohmann::ordered_json result{{"file", arguments.input},
                                {"format", found.format},
                                {"vertices", mesh.vertex_count()},
                                {"dimension", mesh.dimension},
                                {"cells", cells_by_type(mesh)},
                                {"degenerate_cells", found.degenerate},
                                {"graph",
                                 {{"edges", found.graph.edge_count()},
                                  {"components", facts.components.components - facts.components.isolated},
                                  {"isolated_vertices", facts.components.isolated}}},
                                {"edge_span", to_json(facts.span)},
                                {"bandwidth", facts.span.max},
                                {"profile", facts.profile},
                                {"span_histogram_log2", facts.histogram}};
  if (found.stored != nullptr) result["matrix"] = to_json(mesh, found.matrix);
  if (found.reuse) {
    result["caches"] = found.caches.level_bytes;
    result["reuse"] = to_json(*found.reuse, found.caches, kernels_of(mesh));
  }
  result["verdict"] = found.advice ? to_json(*found.advice) : nullptr;
  result["order"] = found.advice ? grade_json(*found.advice, mesh.vertex_count()) : nullptr;
  if (found.gpu) result["gpu"] = to_json(*found.gpu);
  result.update(attachments(mesh));
  return result;
}

void run(const InfoArguments& arguments) {
  Console console(arguments);
  Notes notes;
  const Stopwatch since_start;
  // refuse wrong options before anything takes time
  if (!arguments.caches.empty()) (void)parse_caches(arguments.caches);
  if (arguments.kernels == KernelSet::tuned && !arguments.measure) {
    throw CommandError("--kernels tuned: these are not predicted; give --measure, too", 2);
  }
  MachineChoice machine = choose_machine(arguments.machine, arguments.all_threads && !arguments.measure);
  confine({.meshes = {arguments.input}, .others = named_files(arguments.points)});
  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.3);
  Mesh mesh = read_input(arguments.input, notes, arguments.measure ? 3 * kBytesToMeasure : kBytesToPredict);
  take_points(mesh, arguments.input, arguments.points);

  const CellSimplices simplices(mesh);
  const By by = judged_by(arguments, mesh, simplices, machine);
  // calibrate only if the user requested times of this machine
  const bool calibrates = arguments.predict || arguments.machine == "this" || arguments.all_threads;
  if (by == By::prediction && calibrates && is_predicted(arguments, simplices)) {
    machine = calibrated(std::move(machine), arguments.all_threads, progress, console.quiet(), notes);
  }
  if (by == By::prediction && !machine.fault.empty())
    notes.push_back(machine.fault + "; `meshorder calibrate` measures it again");
  progress.stage("measuring", 0.3, 0.6);
  Findings found = counted(arguments, mesh, simplices, by);
  found.caches = arguments.caches.empty() ? machine.model.caches : parse_caches(arguments.caches);
  progress.stage(by == By::counts       ? "counting"
                 : by == By::prediction ? "predicting"
                                        : "running kernels",
                 0.6, 1);
  if (by == By::counts) {
    found.gpu = gpu_report(mesh, found.graph, gpu_card(arguments.card));
    notes.insert(notes.end(), found.gpu->notes.begin(), found.gpu->notes.end());
  } else {
    found.advice = advice_on(arguments, mesh, found.graph, found.graph_seconds, simplices, found.reuse,
                             machine, by, since_start);
  }
  progress.finish();
  if (found.advice && !found.advice->doubt.empty()) notes.push_back(found.advice->doubt);
  console.warn_of(notes);
  print_findings(console, arguments, mesh, found);
  console.print_json(info_json(arguments, mesh, found));
}

}  // namespace

void add_info(CLI::App& subcommand) {
  subcommand.description(
      "Say whether the order of a mesh file is good, and show what the file holds. The gain of a better\n"
      "order is measured by kernels on meshes of up to 250,000 simplices, and predicted on larger ones.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder info dragon.veg\n"
      "  meshorder info dragon.veg --details\n"
      "  meshorder info dragon.veg --gpu");
  const auto arguments = std::make_shared<InfoArguments>();
  subcommand.add_option("MESH", arguments->input, "Mesh, matrix or graph file")->required();
  add_points_option(subcommand, arguments->points);
  CLI::Option* const gpu = subcommand.add_flag(
      "--gpu", arguments->gpu,
      "Judge the order for a graphics processor instead: count the sectors of memory that kernels\n"
      "touch in this order and in that of `order --for gpu`");
  subcommand.add_option("--card", arguments->card, "Also compute times of element forces on this card, h100")
      ->check(CLI::IsMember(gpu_card_names()))
      ->needs(gpu);
  add_cache_option(subcommand, arguments->caches);
  add_machine_option(subcommand, arguments->machine);
  add_all_threads_option(subcommand, arguments->all_threads);
  subcommand.add_flag("--details", arguments->details,
                      "Also show a histogram of the spans, and cache misses");
  CLI::Option* const measure = subcommand.add_flag(
      "--measure", arguments->measure,
      "Run the kernels for a few seconds on a mesh of any size, and predict their times, too");
  subcommand
      .add_flag("--predict", arguments->predict,
                "Predict the gain for up to 100 million simplices. The first call calibrates this machine")
      ->excludes(measure);
  add_kernels_option(subcommand, arguments->kernels);
  for (const char* const on_processors :
       {"--cache", "--machine", "--all-threads", "--measure", "--predict", "--kernels"}) {
    gpu->excludes(subcommand.get_option(on_processors));
  }
  add_reading_options(subcommand);
  add_common(subcommand, *arguments, std::string(kQuiet) + ": status 0 means that the file can be read");
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
