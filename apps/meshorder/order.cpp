// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "io/format.hpp"
#include "io/format_choice.hpp"
#include "io/stream/output_set.hpp"
#include "machines.hpp"
#include "matrix_points.hpp"
#include "mesh/graphs.hpp"
#include "mesh/groups.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include "mesh_files.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/judgement.hpp"
#include "payoff/race.hpp"
#include "progress.hpp"
#include "stage_times.hpp"
#include "verdict.hpp"
#include "wording.hpp"
#include <meshorder/io.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

struct OrderArguments : Common, MeshFiles {
  ReorderOptions reordering;
  std::string ids = "renumber";
  bool measure = false;
  bool predict = false;
  std::string machine;
  bool all_threads = false;
  bool timings = false;
};

/// Throws InvalidArgument if the arguments leave nothing for a race to decide.
void check_race(const OrderArguments& arguments) {
  const char* const option = arguments.measure ? "--measure" : "--predict";
  const ReorderOptions& options = arguments.reordering;
  const Workload use = options.order.workload;
  if (!is_told_by_kernels(use)) {
    throw InvalidArgument(fmt::format("{} goes by the times of kernels, which say nothing of --for {}",
                                      option, to_string(use)));
  }
  if (options.methods != MeshMethods{} || !options.group_by.empty()) {
    throw InvalidArgument(fmt::format(
        "{} chooses the methods: leave out --vertices, --elements and --group-by, or see meshorder compare",
        option));
  }
}

/// Returns "hilbert/lexmax 2.31, spectral/lexmax 2.29 times as fast as the file's order".
std::string in_words(const Race& race) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < race.advice.candidates.size(); ++i) {
    const Candidate& candidate = race.advice.candidates[i];
    words.push_back(
        fmt::format("{}/{} {:.2f}", candidate.vertices.name, candidate.elements.name, race.factors[i]));
  }
  return join(words) + " times as fast as the file's order";
}

/// @param stored  null if the mesh is not a matrix
void print_result(const Console& console, const MeshOrder& order, const std::optional<Grouping>& groups,
                  const EdgeSpan& before, const EdgeSpan& after, const StoredMatrix* stored) {
  const bool is_matrix = stored != nullptr && !stored->is_graph;
  const auto print_method = [&](const char* of, const MethodChoice& method, double seconds) {
    console.print("{:<10} {:<14} {}", of, method_in_words(method), duration(seconds));
    if (!method.reason.empty()) console.print("{:<10} {}", "", method.reason);
  };
  print_method(is_matrix ? "rows" : "vertices", order.vertices.method, order.vertices.seconds);
  // entries stay unless a method is named for them; a graph's file lists edges in the order of its vertices
  const bool entries_stay = stored != nullptr && !order.cells.method.reason.empty();
  if (!entries_stay)
    print_method(stored != nullptr ? "entries" : "elements", order.cells.method, order.cells.seconds);
  else if (is_matrix)
    console.print("{:<10} keep their places in the file", "entries");
  if (groups) console.print("{:<10} {}", "groups", groups_in_words(*groups));
  console.print("{:<10} mean {:.1f} → {:.1f}, largest {} → {}, mean log2 {:.2f} → {:.2f}",
                stored != nullptr ? "distance" : "edge span", before.mean, after.mean,
                with_commas(before.max), with_commas(after.max), before.mean_log2, after.mean_log2);
}

/// Notes a method that was requested by name and does not improve the order of the vertices.
void note_no_better(GraphRef graph, const ReorderOptions& options, const Permutation& vertices,
                    Notes& notes) {
  const std::string& method = options.methods.vertices;
  if (method == "auto" || method == "original" || method == "scrambled" || !options.group_by.empty()) return;
  const std::string reason = reason_to_keep(graph, vertices, method, made_for(method));
  if (!reason.empty()) notes.push_back(reason + "; --vertices original keeps the order");
}

/// Notes a method that was requested by name and does not improve the order of the elements. `mesh` has been
/// reordered by `cells`.
void note_no_better(const Mesh& mesh, const ReorderOptions& options, const Permutation& cells, Notes& notes) {
  const std::string& method = options.methods.elements;
  if (method == "auto" || method == "original" || method == "scrambled" || !options.group_by.empty()) return;
  const CellSelection elements = CellSelection::elements(cell_arrays(mesh));
  const Permutation as_written = Permutation::identity(elements.size());
  std::vector<Index> element_of(static_cast<std::size_t>(cells.size()), -1);  // of each cell
  for (Index e = 0; e < elements.size(); ++e) element_of[elements.cell(e)] = e;
  std::vector<Index> as_it_was;
  as_it_was.reserve(static_cast<std::size_t>(elements.size()));
  for (const Index cell : cells.old_to_new()) {
    if (element_of[cell] >= 0) as_it_was.push_back(element_of[cell]);
  }
  const std::string reason =
      reason_to_keep_elements(elements.incidence(), as_it_was, as_written.new_to_old(), method);
  if (!reason.empty()) notes.push_back(reason + "; --elements original keeps the order");
}

/// Returns whether the file's numbers of vertices or cells differ from those before they moved. `mesh`
/// has been reordered.
bool has_new_numbers(const Mesh& mesh, const MeshOrder& order, const ReorderOptions& options) {
  const bool are_moved = !order.vertices.permutation.is_identity() || !order.cells.permutation.is_identity();
  const bool are_bound = mesh.format_metadata != nullptr && mesh.format_metadata->binds_ids();
  return are_moved && !are_bound && options.ids != Ids::keep && has_numbers(format_named(options.format));
}

/// Returns {"count", "method", "chosen_by", "because", "kept", "seconds"}.
nlohmann::ordered_json half_json(Index count, const Order& order) {
  nlohmann::ordered_json result{{"count", count}};
  result.update(to_json(order.method));
  result["kept"] = order.permutation.is_identity();
  result["seconds"] = order.seconds;
  return result;
}

void run(const OrderArguments& arguments) {
  Console console(arguments);
  ReorderOptions options = arguments.reordering;
  options.ids = parse<Ids>(arguments.ids);
  (void)output_format_of(arguments.output);  // fail before the work
  const bool in_race = arguments.measure || arguments.predict;
  if (in_race) check_race(arguments);
  if (!in_race && (!arguments.machine.empty() || arguments.all_threads)) {
    throw InvalidArgument(fmt::format("{} is for --predict and --measure, which choose by predicted times",
                                      arguments.machine.empty() ? "--all-threads" : "--machine"));
  }
  std::optional<MachineChoice> machine;
  if (in_race) machine = choose_machine(arguments.machine, arguments.all_threads);
  check_can_write(arguments);  // fail before the work
  confine({.meshes = {arguments.input},
           .others = named_files(arguments.points),
           .outputs = {arguments.output},
           .maps_written = arguments.maps});

  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.4);
  StageTimes times;
  Notes notes;
  const std::uint64_t bytes_of_race = arguments.measure ? 3 * kBytesToMeasure : kBytesToPredict;
  MeshToOrder job = read_to_order(arguments, notes, in_race ? bytes_of_race : kBytesToOrder);
  Mesh& mesh = job.mesh;
  options.format = output_format_of(arguments.output, mesh.format).key();
  require_points(mesh, arguments.input, options.methods.vertices, options.methods.elements);
  times.end("read");
  times.set_bytes("read", bytes_on_disk(arguments.input));

  // on all threads, a race needs the costs of a calibration to choose by
  if (arguments.predict || (arguments.measure && arguments.all_threads)) {
    machine = calibrated(*std::move(machine), arguments.all_threads, progress, console.quiet(), notes);
  }
  progress.stage("ordering", 0.4, 0.7);
  if (in_race) times.end("calibrate");
  std::optional<Grouping> groups;
  if (!options.group_by.empty()) groups = grouping_by(mesh, options.group_by);
  std::optional<CsrGraph> graph = vertex_graph(mesh);
  times.end("graph");
  std::optional<Race> raced;
  if (in_race) {
    raced = race(mesh, *graph,
                 {.ordering = options.order,
                  .graph_seconds = times.seconds("graph"),
                  .machine = *std::move(machine),
                  .timer = arguments.measure ? time_orders : OrderTimer{}});
    options.methods = raced->methods();
    if (!raced->advice.doubt.empty()) notes.push_back(raced->advice.doubt);
    times.end("race");
  }
  MeshOrder order = reorder(mesh, options, graph);
  if (raced) give_reasons(*raced, order);
  times.end("move");
  times.split_last("order", order.vertices.seconds + order.cells.seconds);
  job.maps.vertices = order.vertices.permutation;
  job.maps.cells = order.cells.permutation;
  const EdgeSpan before = quick_edge_span(*graph, Permutation::identity(mesh.vertex_count()));
  const EdgeSpan after = quick_edge_span(*graph, job.maps.vertices);
  if (!raced) {
    note_no_better(*graph, options, job.maps.vertices, notes);
    note_no_better(mesh, options, job.maps.cells, notes);
  }
  note_convergence(order.vertices.fiedler, "the vertices", notes);
  note_convergence(order.cells.fiedler, "the elements", notes);
  times.end("spans");

  progress.stage("writing " + arguments.output, 0.7, 1);
  OutputSet outputs;
  const std::vector<std::string> map_files = write_ordered(job, arguments, outputs, notes);
  times.end("write");
  outputs.commit();
  notes.insert(notes.end(), outputs.notes().begin(), outputs.notes().end());
  times.end("sync");
  for (const char* const stage : {"write", "sync"}) times.set_bytes(stage, bytes_on_disk(arguments.output));

  progress.finish();
  console.warn_of(notes);
  if (raced) console.print("{:<10} {}", "race", in_words(*raced));
  print_result(console, order, groups, before, after, stored_matrix(mesh));
  if (has_new_numbers(mesh, order, options)) {
    console.print("{:<10} {}", "numbers", "of vertices and cells are new; --ids keep keeps the old ones");
  }
  console.print("{:<10} {}", "wrote", arguments.output);
  for (const std::string& file : map_files) console.print("{:<10} {}", "", file);
  if (arguments.timings) times.print(console);
  nlohmann::ordered_json result{{"input", arguments.input},
                                {"output", arguments.output},
                                {"vertices", half_json(mesh.vertex_count(), order.vertices)},
                                {"cells", half_json(mesh.cell_count(), order.cells)},
                                {"for", to_string(options.order.workload)},
                                {"race", raced ? to_json(raced->advice) : nullptr},
                                {"group_by", groups ? to_json(*groups) : nullptr},
                                {"edge_span", {{"before", to_json(before)}, {"after", to_json(after)}}},
                                {"fiedler", to_json(order.vertices.fiedler)},
                                {"element_fiedler", to_json(order.cells.fiedler)},
                                {"maps", map_files},
                                {"seconds",
                                 {{"read", times.seconds("read")},
                                  {"order", times.seconds("graph") + times.seconds("race") +
                                                times.seconds("order") + times.seconds("move")},
                                  {"write", times.seconds("write") + times.seconds("sync")}}},
                                {"timings", times.to_json()}};
  console.print_json(result);
}

}  // namespace

void add_order(CLI::App& subcommand) {
  subcommand.description(
      "Reorder a mesh with all its data, labels and groups. The extension of the output sets its format.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder order dragon.veg -o ordered.veg\n"
      "  meshorder order part.msh -o part.vtu --for spmv --maps part\n"
      "  meshorder order dragon.veg -o ordered.veg --measure\n"
      "Parts and pieces for programs of many ranks: see meshorder-mpi order --help");
  const auto arguments = std::make_shared<OrderArguments>();
  subcommand.add_option("MESH", arguments->input, "Mesh, matrix or graph file")->required();
  subcommand.add_option("-o,--output", arguments->output, "File to write; may be the input")->required();
  subcommand
      .add_option("--vertices", arguments->reordering.methods.vertices,
                  "Method for vertices, see `meshorder methods`")
      ->capture_default_str();
  subcommand
      .add_option(
          "--elements", arguments->reordering.methods.elements,
          "Method for elements, see `meshorder methods`. Entries of a matrix keep their places in the\n"
          "file unless a method is named")
      ->capture_default_str();
  add_points_option(subcommand, arguments->points);
  subcommand
      .add_option(
          "--group-by", arguments->reordering.group_by,
          "Keep groups together. NAME is an array of integers that `meshorder info` lists, or `sets`.\n"
          "`label` is the file's own cell tag (Gmsh's first physical group, Medit's reference);\n"
          "gmsh:geometrical: Gmsh's entities; attribute: TetGen's regions; sets: Vega's regions and\n"
          "named physical groups. Cells are sorted by value, each group in the methods' order; a\n"
          "vertex has the smallest value among its elements. An array on vertices groups only\n"
          "the vertices. Write cells:NAME or vertices:NAME if both have that array (default: cells).\n"
          "Cells and vertices without a value come last")
      ->type_name("NAME");
  subcommand.add_flag(
      "--measure", arguments->measure,
      "Time the kernels for about two seconds, in the file's order, in the one that `auto` takes and\n"
      "in the two predicted to be the best of five others, and take the fastest. Useful for meshes on\n"
      "which programs run for long. The result may differ from run to run, and between machines");
  subcommand
      .add_flag(
          "--predict", arguments->predict,
          "Like --measure, without timing: take the order whose predicted times on --machine are the least.\n"
          "The same costs give the same order; the first call on a machine calibrates it, in 40 to 60 s")
      ->excludes("--measure");
  add_machine_option(subcommand, arguments->machine);
  add_all_threads_option(subcommand, arguments->all_threads);
  add_moving_options(subcommand, *arguments, arguments->ids);
  add_ordering_options(subcommand, arguments->reordering.order);
  add_reading_options(subcommand);
  subcommand.add_flag(
      "--timings", arguments->timings,
      "Print what each stage takes: reading, the graph, the orders, moving, writing, and the disk");
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
