// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "command.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "io/format.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"
#include "machines.hpp"
#include "matrix_points.hpp"
#include "mesh/graphs.hpp"
#include "mesh/groups.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include "mesh_files.hpp"
#include "metrics/edge_span.hpp"
#include "order_report.hpp"
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
  if (!is_judged_by_kernels(use)) {
    throw InvalidArgument(
        fmt::format("{} chooses by kernel times, which do not apply to --for {}", option, to_string(use)));
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

/// Returns {"count", "method", "chosen_by", "because", "kept", "seconds"}.
nlohmann::ordered_json half_json(Index count, const Order& order) {
  nlohmann::ordered_json result{{"count", count}};
  result.update(to_json(order.method));
  result["kept"] = order.permutation.is_identity();
  result["seconds"] = order.seconds;
  return result;
}

bool is_race(const OrderArguments& arguments) { return arguments.measure || arguments.predict; }

/// Throws for arguments that do not fit together.
void check(const OrderArguments& arguments) {
  (void)output_format_of(arguments.output);
  if (is_race(arguments)) {
    check_race(arguments);
  } else if (!arguments.machine.empty() || arguments.all_threads) {
    throw InvalidArgument(fmt::format("{} is for --predict and --measure, which choose by predicted times",
                                      arguments.machine.empty() ? "--all-threads" : "--machine"));
  }
}

/// One call of the command. Its public functions are called once each, in this order.
class Ordering {
 public:
  /// @param machine  for a race
  Ordering(const OrderArguments& arguments, std::optional<MachineChoice> machine)
      : arguments_(arguments),
        console_(arguments),
        progress_(!console_.quiet()),
        machine_(std::move(machine)) {
    options_.ids = parse<Ids>(arguments.ids);
  }

  void read() {
    progress_.stage("reading " + arguments_.input, 0, 0.4);
    const std::uint64_t bytes_of_race = arguments_.measure ? 3 * kBytesToMeasure : kBytesToPredict;
    job_ = read_to_order(arguments_, notes_, is_race(arguments_) ? bytes_of_race : kBytesToOrder);
    options_.format = job_.format->key();
    require_points(job_.mesh, arguments_.input, options_.methods.vertices, options_.methods.elements);
    times_.end("read");
    times_.set_bytes("read", bytes_on_disk(arguments_.input));
  }

  /// Arranges the cells for the output format and computes the order.
  void order() {
    if (is_race(arguments_)) calibrate();
    progress_.stage("ordering", 0.4, 0.7);
    Mesh& mesh = job_.mesh;
    if (!options_.group_by.empty()) groups_ = grouping_by(mesh, options_.group_by);
    const CsrGraph graph = vertex_graph(mesh);
    times_.end("graph");
    if (is_race(arguments_)) run_race(graph);
    check_holds_ids(*job_.format, options_.ids);
    job_.arranged = arrange_cells(mesh, *job_.format);
    order_ = compute_order_in_file(mesh, graph, options_);
    times_.end("order");
    const Permutation& vertices = order_.vertices.permutation;
    spans_ = {quick_edge_span(graph, {}), quick_edge_span(graph, vertices.old_to_new())};
    if (!raced_) note_no_better(graph, options_, vertices, notes_);
    times_.end("spans");
  }

  void move() {
    Mesh& mesh = job_.mesh;
    order_.cells.permutation =
        move_in_file(mesh, order_.vertices.permutation, std::move(order_.cells.permutation), job_.format,
                     job_.arranged, options_.ids);
    if (!arguments_.maps.empty()) {
      job_.maps.vertices = order_.vertices.permutation;
      job_.maps.cells = order_.cells.permutation;
    }
    times_.end("move");
    if (raced_) {
      give_reasons(*raced_, order_);
    } else {
      note_no_better(mesh, options_, order_.cells.permutation, notes_);
    }
    note_convergence(order_.vertices.fiedler, "the vertices", notes_);
    note_convergence(order_.cells.fiedler, "the elements", notes_);
    times_.end("spans");
  }

  void write() {
    progress_.stage("writing " + arguments_.output, 0.7, 1);
    OutputSet outputs;
    written_ = write_ordered(job_, arguments_, outputs, notes_);
    times_.end("write");
    outputs.commit();
    notes_.insert(notes_.end(), outputs.notes().begin(), outputs.notes().end());
    times_.end("sync");
    for (const char* const stage : {"write", "sync"})
      times_.set_bytes(stage, bytes_on_disk(arguments_.output));
  }

  void print() {
    progress_.finish();
    console_.warn_of(notes_);
    if (raced_) console_.print("{:<10} {}", "race", in_words(*raced_));
    for (const std::string& line : lines_of_order(order_, groups_, spans_, stored_matrix(job_.mesh)))
      console_.print("{}", line);
    if (has_new_numbers(job_.mesh, order_, *job_.format, options_.ids)) {
      console_.print("{:<10} {}", "numbers", "new for vertices and cells; --ids keep keeps the old ones");
    }
    console_.print("{:<10} {}", "wrote", join(written_.mesh));
    for (const std::string& file : written_.maps) console_.print("{:<10} {}", "", file);
    if (arguments_.timings) times_.print(console_);
    console_.print_json(to_json());
  }

 private:
  /// Calibrates this machine if times are predicted or all threads share each run.
  void calibrate() {
    if (arguments_.predict || arguments_.all_threads) {
      machine_ =
          calibrated(*std::move(machine_), arguments_.all_threads, progress_, console_.quiet(), notes_);
    }
    times_.end("calibrate");
  }

  /// Lets a race choose the methods.
  void run_race(const CsrGraph& graph) {
    raced_ = race(job_.mesh, graph,
                  {.ordering = options_.order,
                   .format = options_.format,
                   .graph_seconds = times_.seconds("graph"),
                   .machine = *std::move(machine_),
                   .timer = arguments_.measure ? time_orders : OrderTimer{}});
    options_.methods = raced_->methods();
    if (!raced_->advice.doubt.empty()) notes_.push_back(raced_->advice.doubt);
    times_.end("race");
  }

  [[nodiscard]] nlohmann::ordered_json to_json() const {
    return {{"input", arguments_.input},
            {"output", arguments_.output},
            {"files", written_.mesh},
            {"vertices", half_json(job_.mesh.vertex_count(), order_.vertices)},
            {"cells", half_json(job_.mesh.cell_count(), order_.cells)},
            {"for", to_string(options_.order.workload)},
            {"race", raced_ ? command::to_json(raced_->advice) : nullptr},
            {"group_by", groups_ ? command::to_json(*groups_) : nullptr},
            {"edge_span",
             {{"before", command::to_json(spans_.before)}, {"after", command::to_json(spans_.after)}}},
            {"fiedler", command::to_json(order_.vertices.fiedler)},
            {"element_fiedler", command::to_json(order_.cells.fiedler)},
            {"maps", written_.maps},
            {"seconds",
             {{"read", times_.seconds("read")},
              {"order", times_.seconds("graph") + times_.seconds("race") + times_.seconds("order") +
                            times_.seconds("move")},
              {"write", times_.seconds("write") + times_.seconds("sync")}}},
            {"timings", times_.to_json()}};
  }

  const OrderArguments& arguments_;
  ReorderOptions options_ = arguments_.reordering;
  Console console_;
  Progress progress_;
  StageTimes times_;
  Notes notes_;
  std::optional<MachineChoice> machine_;
  MeshToOrder job_;
  std::optional<Grouping> groups_;
  std::optional<Race> raced_;
  MeshOrder order_;
  SpanChange spans_;
  WrittenFiles written_;
};

void run(const OrderArguments& arguments) {
  // before the work, report wrong arguments and outputs that cannot be written
  check(arguments);
  std::optional<MachineChoice> machine;
  if (is_race(arguments)) machine = choose_machine(arguments.machine, arguments.all_threads);
  (void)OutputFile(arguments.output);
  if (!arguments.maps.empty()) check_can_write_maps(arguments.maps);
  confine({.meshes = {arguments.input},
           .others = named_files(arguments.points),
           .outputs = {arguments.output},
           .maps_written = arguments.maps});
  Ordering ordering(arguments, std::move(machine));
  ordering.read();
  ordering.order();
  ordering.move();
  ordering.write();
  ordering.print();
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
      .add_option("--elements", arguments->reordering.methods.elements,
                  "Method for elements, see `meshorder methods`. With auto, the entries of a matrix\n"
                  "keep their places in the file")
      ->capture_default_str();
  add_points_option(subcommand, arguments->points);
  subcommand
      .add_option(
          "--group-by", arguments->reordering.group_by,
          "Keep groups together. NAME is an array of integers that `meshorder info` lists, or `sets`.\n"
          "label: the file's own cell tag, such as Gmsh's first physical group or Medit's reference;\n"
          "gmsh:geometrical: Gmsh's entities; attribute: TetGen's regions; sets: Vega's regions and\n"
          "named physical groups. Cells are sorted by value, and the methods order each group. A\n"
          "vertex gets the smallest value of its elements. An array on vertices groups only\n"
          "the vertices. Write cells:NAME or vertices:NAME if both have that array (default: cells).\n"
          "Cells and vertices without a value come last")
      ->type_name("NAME");
  subcommand.add_flag(
      "--measure", arguments->measure,
      "Time the kernels for about two seconds and take the fastest order. The candidates are the file's\n"
      "order, that of `auto`, and the two of five others with the best predictions. Useful for meshes on\n"
      "which programs run for long. The result may differ between runs and between machines");
  subcommand
      .add_flag(
          "--predict", arguments->predict,
          "Like --measure, without timing: take the order with the shortest predicted times on --machine.\n"
          "The same calibration gives the same order. The first call on a machine calibrates it, which\n"
          "takes 40 to 60 s")
      ->excludes("--measure");
  add_machine_option(subcommand, arguments->machine);
  add_all_threads_option(subcommand, arguments->all_threads);
  add_moving_options(subcommand, *arguments, arguments->ids);
  add_ordering_options(subcommand, arguments->reordering.order);
  add_reading_options(subcommand);
  subcommand.add_flag(
      "--timings", arguments->timings,
      "Print the time of each stage: reading, the graph, the orders, moving, writing, and the disk");
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
