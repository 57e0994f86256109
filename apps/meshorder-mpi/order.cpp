// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "order.hpp"

#include "base/memory.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "command.hpp"
#include "console.hpp"
#include "distributed/files/exodus_slices.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/file_slices.hpp"
#include "distributed/order/mesh_slice.hpp"
#include "distributed/order/order.hpp"
#include "matrix_points.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include "order_outputs.hpp"
#include "ordering/method.hpp"
#include "sliced_maps.hpp"
#include "whole_mesh.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace meshorder::command {
namespace {

using distributed::Communicator;
using distributed::DistributedOptions;
using distributed::DistributedOrder;
using distributed::DistributedReport;
using distributed::ExodusSlices;
using distributed::FileHead;
using distributed::FileSlices;
using distributed::GlobalEdgeSpan;
using distributed::GlobalIndex;

struct Arguments : Common, OrderFiles {
  std::string vertices = "auto";
  std::string partition = "auto";
  Index parts = 0;
  std::string balance{to_string(distributed::Balance::vertices)};
  std::string interface_place{to_string(distributed::InterfacePlace::mixed)};
  OrderOptions order;
  std::string ids = "renumber";
  bool is_started_as_rank = false;
};

DistributedOptions options_of(const Arguments& arguments) {
  DistributedOptions options;
  if (arguments.vertices != "auto") options.vertices = arguments.vertices;
  if (arguments.partition != "auto") {
    options.partitioner = parse<distributed::Partitioner>(arguments.partition);
  } else if (options.vertices == "fiedler") {
    options.partitioner = distributed::Partitioner::order;
  }
  options.parts = arguments.parts;
  options.balance = parse<distributed::Balance>(arguments.balance);
  options.interface_place = parse<distributed::InterfacePlace>(arguments.interface_place);
  options.order = arguments.order;
  return options;
}

/// Returns whether rank 0 has to read and write: for --ids, --only, --strict and --points.
bool needs_root(const Arguments& arguments) {
  return arguments.ids != "renumber" || arguments.keeping.dimension >= 0 || arguments.keeping.strict ||
         !arguments.points.empty();
}

/// Throws SharedError if a process that was started alone has to write pieces without a number of parts.
void check_count_of_pieces(const Communicator& communicator, const Arguments& arguments) {
  communicator.together([&] {
    if (arguments.is_started_as_rank || arguments.parts > 0 || arguments.pieces.empty()) return;
    throw InvalidArgument(
        "--pieces: one process makes one piece; give --parts N, or start it with mpirun -n N");
  });
}

/// Throws SharedError if there are more parts than vertices. `mesh` is empty unless the root read it.
void check_parts(const Communicator& communicator, Index parts, GlobalIndex vertices, const Mesh& mesh) {
  communicator.at_root([&] {
    if (parts <= vertices) return;
    const StoredMatrix* const stored = stored_matrix(mesh);
    const bool has_rows = stored != nullptr && !stored->is_graph;
    throw InvalidArgument(fmt::format("--parts: the {} has {} {}, too few for {} parts",
                                      has_rows            ? "matrix"
                                      : stored != nullptr ? "graph"
                                                          : "mesh",
                                      with_commas(vertices), has_rows ? "rows" : "vertices",
                                      with_commas(parts)));
  });
}

/// Throws SharedError if the root read a matrix without coordinates and an option names a method that needs
/// them.
void require_points_of(const Communicator& communicator, const Mesh& mesh, const Arguments& arguments) {
  communicator.at_root([&] {
    if (needs_points(vertex_methods(), arguments.vertices))
      require_coordinates(mesh, arguments.input, fmt::format("order '{}'", arguments.vertices),
                          {"spectral", "fiedler", "rcm"});
    if (arguments.partition == "hilbert")
      require_coordinates(mesh, arguments.input, "partition 'hilbert'", {"ptscotch", "rsb"});
  });
}

/// Returns the head of the input if all ranks can read it in parts; nothing if they cannot or if
/// - the input is not a .vtu, .vtkhdf or .xdmf file;
/// - the output has another extension than the input;
/// - rank 0 has to read and write;
/// - maps are wanted, but no output is, or the file orders the nodes of its cells unlike a Mesh;
/// - pieces of an .xdmf file, or pieces in Nemesis, are wanted.
std::optional<FileHead> head_of(const Communicator& communicator, const Arguments& arguments) {
  const auto extension = [](const std::string& name) { return std::filesystem::path(name).extension(); };
  const std::filesystem::path kind = extension(arguments.input);
  const bool with_maps = !arguments.maps.empty();
  const bool is_xdmf = distributed::is_xdmf(arguments.input);
  if ((kind != ".vtu" && kind != ".vtkhdf" && !is_xdmf) || (is_xdmf && !arguments.pieces.empty()) ||
      arguments.has_nemesis_pieces() || (!arguments.output.empty() && extension(arguments.output) != kind) ||
      needs_root(arguments) || (with_maps && arguments.output.empty())) {
    return std::nullopt;
  }
  std::optional<FileHead> head = shared_head(communicator, arguments.input);
  if (head && with_maps && !FileSlices(communicator, *head).has_nodes_as_a_mesh()) head.reset();
  return head;
}

/// Returns the input if all ranks can read it in parts as an Exodus file; nothing if they cannot or if
/// - an output is wanted, or rank 0 has to read and write;
/// - pieces in Nemesis are wanted but cannot keep the file's blocks.
std::optional<ExodusSlices> exodus_slices_of(const Communicator& communicator, const Arguments& arguments) {
  if (!arguments.output.empty() || needs_root(arguments)) return std::nullopt;
  std::optional<ExodusSlices> slices = ExodusSlices::open(communicator, arguments.input);
  if (slices && arguments.has_nemesis_pieces() && !slices->has_blocks_of_pieces()) slices.reset();
  return slices;
}

nlohmann::ordered_json span_json(const GlobalEdgeSpan& span) {
  return {{"mean", span.mean}, {"max", span.max}, {"mean_log2", span.mean_log2}};
}

double share_of_edges(const DistributedReport& report) {
  return report.edges > 0 ? static_cast<double>(report.cut) / static_cast<double>(report.edges) : 0;
}

/// Returns the peak memory of this process so far, in bytes; 0 if the system does not report it.
std::int64_t peak_memory() {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-union-access): glibc's declaration
  return std::int64_t{usage.ru_maxrss} * 1024;  // Linux counts in KiB
}

/// Prints the report on an order, without file names.
///
/// @param stored  null unless the mesh is a matrix or graph
void print_report(const Console& console, const DistributedOptions& options, const DistributedReport& report,
                  const std::vector<std::int64_t>& peaks, const StoredMatrix* stored) {
  const bool is_matrix = stored != nullptr && !stored->is_graph;
  console.print(
      "{:<10} {} by {}, {:.2f} % of the edges between them, largest {:.3f} of the mean by {}, {} neighbours "
      "in other parts",
      "parts", report.parts, to_string(report.partitioner), 100 * share_of_edges(report), report.imbalance,
      to_string(options.balance), with_commas(report.ghosts));
  console.print(
      "{:<10} {} {}, {} on the interfaces{}", is_matrix ? "rows" : "vertices", options.vertices,
      report.partitioner == distributed::Partitioner::order ? "of the whole mesh" : "in each part",
      with_commas(std::accumulate(report.interfaces.begin(), report.interfaces.end(), GlobalIndex{0})),
      options.interface_place == distributed::InterfacePlace::last ? ", after the others" : "");
  if (stored == nullptr) console.print("{:<10} lexmax", "elements");
  if (is_matrix) console.print("{:<10} keep their places in the file", "entries");
  console.print("{:<10} mean {:.1f} → {:.1f}, largest {} → {}, mean log2 {:.2f} → {:.2f}",
                stored != nullptr ? "distance" : "edge span", report.before.mean, report.after.mean,
                with_commas(report.before.max), with_commas(report.after.max), report.before.mean_log2,
                report.after.mean_log2);
  std::string stages;
  for (const auto& [stage, seconds] : report.seconds)
    stages += fmt::format("{}{} {}", stages.empty() ? "" : ", ", stage, duration(seconds));
  console.print("{:<10} {}", "time", stages);
  console.print("{:<10} at most {} on a rank, {} on rank 0", "memory",
                size_text(static_cast<std::uint64_t>(*std::max_element(peaks.begin(), peaks.end()))),
                size_text(static_cast<std::uint64_t>(peaks.front())));
}

/// Returns {"ranks", "parts", "partition", "edge_span", "memory_bytes", "seconds"}.
nlohmann::ordered_json to_json(const DistributedOptions& options, const DistributedReport& report,
                               const std::vector<std::int64_t>& peaks) {
  nlohmann::ordered_json seconds;
  for (const auto& [stage, time] : report.seconds) seconds[std::string(stage)] = time;
  const std::vector<distributed::GlobalIndex> first_vertices(report.part_starts.begin(),
                                                             report.part_starts.end() - 1);
  return {{"ranks", peaks.size()},
          {"parts", report.parts},
          {"partition",
           {{"method", to_string(report.partitioner)},
            {"because", or_null(report.partition_reason)},
            {"edges", report.edges},
            {"cut", report.cut},
            {"balance", to_string(options.balance)},
            {"imbalance", report.imbalance},
            {"ghosts", report.ghosts},
            {"first_vertices", first_vertices},
            {"interface", to_string(options.interface_place)},
            {"interface_vertices", report.interfaces}}},
          {"edge_span", {{"before", span_json(report.before)}, {"after", span_json(report.after)}}},
          {"memory_bytes", peaks},
          {"seconds", seconds}};
}

/// The results of a run, which the root reports.
struct Finished {
  const Arguments& arguments;
  const DistributedOptions& options;
  const distributed::DistributedReport& report;
  const OrderOutputs& outputs;
  const Mesh& whole;  ///< empty if all ranks have read the file
  bool by_all;        ///< all ranks have read and written the files, not the root alone
  GlobalIndex vertices;
  GlobalIndex cells;
  const std::vector<std::int64_t>& peaks;  ///< memory of each rank, in bytes
};

nlohmann::ordered_json json_of(const Finished& run) {
  const Arguments& arguments = run.arguments;
  const bool is_matrix = stored_matrix(run.whole) != nullptr;
  nlohmann::ordered_json result{
      {"input", arguments.input},
      {"output", or_null(arguments.output)},
      {"files_by", run.by_all ? "all ranks" : "rank 0"},
      {"vertices", {{"count", run.vertices}, {"method", run.options.vertices}}},
      {"cells", {{"count", run.cells}, {"method", is_matrix ? "original" : "lexmax"}}}};
  result.update(to_json(run.options, run.report, run.peaks));
  result["fiedler"] = command::to_json(run.report.fiedler);
  result["files"] = run.outputs.written().mesh;
  result["maps"] = run.outputs.written().maps;
  if (!arguments.pieces.empty()) {
    result["pieces"] = {{"file", run.outputs.pieces_file()},
                        {"ghost_layers", arguments.ghosts},
                        {"ghost_vertices", run.outputs.pieces().ghost_vertices},
                        {"ghost_cells", run.outputs.pieces().ghost_cells}};
  }
  return result;
}

void print(const Finished& run, Notes notes) {
  const Arguments& arguments = run.arguments;
  const StoredMatrix* const stored = stored_matrix(run.whole);
  Console console(arguments);
  if (!run.report.partition_reason.empty()) {
    const bool by_rows = stored != nullptr && !has_places(run.whole);
    notes.push_back(
        run.report.partition_reason +
        (by_rows ? ": parts are ranges of the rows as they are; --partition rsb divides graphs of any size"
                 : ": parts are ranges of Hilbert's curve"));
  }
  note_convergence(run.report.fiedler, "the vertices", notes);
  console.warn_of(notes);
  print_report(console, run.options, run.report, run.peaks, stored);
  const char* const by = run.by_all ? ", read and written by all ranks" : "";
  if (!arguments.output.empty()) console.print("{:<10} {}{}", "wrote", join(run.outputs.written().mesh), by);
  if (!arguments.pieces.empty()) {
    const distributed::PiecesReport& pieces = run.outputs.pieces();
    console.print("{:<10} {}{}", "wrote", run.outputs.pieces_file(), by);
    console.print("{:<10} {} pieces with {} ghost vertices and {} ghost cells in all", "", run.report.parts,
                  with_commas(pieces.ghost_vertices), with_commas(pieces.ghost_cells));
  }
  for (const std::string& file : run.outputs.written().maps) console.print("{:<10} {}", "", file);
  console.print_json(json_of(run));
  flush_stdout();
}

void run(const Arguments& arguments, const Communicator& communicator) {
  const DistributedOptions options = options_of(arguments);
  check_count_of_pieces(communicator, arguments);
  OrderOutputs outputs(communicator, arguments);
  const Stopwatch reading;
  Notes notes;
  const std::optional<FileHead> head = head_of(communicator, arguments);
  const std::optional<ExodusSlices> exodus = head ? std::nullopt : exodus_slices_of(communicator, arguments);
  const bool by_all = head || exodus;
  MeshToOrder whole;
  if (!by_all) {
    whole = read_at_root(communicator, arguments.with_output(), parse<Ids>(arguments.ids), notes);
    outputs.check(whole.mesh);
    require_points_of(communicator, whole.mesh, arguments);
  }
  distributed::MeshSlice slice = head     ? FileSlices(communicator, *head).read()
                                 : exodus ? exodus->read(communicator)
                                          : distributed::scattered(communicator, whole.mesh);
  const GlobalIndex vertex_count = slice.vertices.size();
  const GlobalIndex cell_count = slice.cells.size();
  check_parts(communicator, arguments.parts, vertex_count, whole.mesh);
  MeshChecksums before;
  if (by_all && !arguments.maps.empty()) before = checksums_of(communicator, slice);
  const double read_seconds = reading.seconds();

  DistributedOrder order = distributed::order_slices(communicator, std::move(slice), options);
  const Stopwatch writing;
  if (head) {
    outputs.write(*head, order, before, notes);
  } else if (exodus) {
    outputs.write(*exodus, order, before, notes);
  } else {
    move_at_root(communicator, whole, order, !arguments.maps.empty(), parse<Ids>(arguments.ids));
    outputs.write(whole, order, notes);
  }
  outputs.commit(notes);

  order.report.seconds.insert(order.report.seconds.begin(), {"read", read_seconds});
  order.report.seconds.emplace_back("write", writing.seconds());
  const std::vector<std::int64_t> peaks = communicator.gathered(peak_memory());
  communicator.at_root([&] {
    print({.arguments = arguments,
           .options = options,
           .report = order.report,
           .outputs = outputs,
           .whole = whole.mesh,
           .by_all = by_all,
           .vertices = vertex_count,
           .cells = cell_count,
           .peaks = peaks},
          std::move(notes));
  });
}

/// Returns the number of threads of this rank: its share of the machine's cores.
int share_of_cores(const Communicator& communicator) {
  return std::max(
      1, static_cast<int>(std::thread::hardware_concurrency()) / communicator.ranks_on_this_machine());
}

/// Adds the options of the parts: their number, how they are made, and how each is ordered.
void add_partition_options(CLI::App& subcommand, Arguments& arguments) {
  subcommand
      .add_option(
          "--vertices", arguments.vertices,
          "Method for the vertices of a part, see `meshorder methods`; `auto` is spectral; fiedler orders\n"
          "the whole mesh unless --partition is ptscotch, hilbert or rsb")
      ->capture_default_str();
  subcommand
      .add_option("--parts", arguments.parts,
                  "Number of parts, at most the number of vertices (rows of a matrix); 0: one for each rank")
      ->check(whole_from(0))
      ->capture_default_str();
  subcommand
      .add_option(
          "--partition", arguments.partition,
          "How the parts are made: `ptscotch` has few edges between them, `hilbert` cuts Hilbert's\n"
          "curve and gives the same parts on any number of ranks, `rsb` halves the mesh and its parts by\n"
          "their Fiedler vectors, `order` cuts one order of the whole mesh, by fiedler only, into equal\n"
          "ranges; `auto` is order for fiedler, else ptscotch")
      ->check(CLI::IsMember({"auto", "ptscotch", "hilbert", "rsb", "order"}))
      ->capture_default_str();
  subcommand
      .add_option(
          "--balance", arguments.balance,
          "Give all parts the same number of `vertices`, or of `cells`. For cells, the weight of a vertex\n"
          "is its share of its elements")
      ->check(CLI::IsMember({"vertices", "cells"}))
      ->capture_default_str();
  subcommand
      .add_option(
          "--interface", arguments.interface_place,
          "Place of the interface, the vertices that share an element with other parts, in each part.\n"
          "`mixed`: among the others, in the method's order. `last`: after the others, so that a program\n"
          "can work on these while it waits for data of the interface")
      ->check(CLI::IsMember({"mixed", "last"}))
      ->capture_default_str();
}

}  // namespace

void add_distributed_order(CLI::App& subcommand, const Communicator& communicator, bool is_started_as_rank) {
  subcommand.description(
      "Reorder a mesh on all ranks: cut it into parts, order each part, and number the parts one after\n"
      "another. Neighbouring parts get close numbers.\n"
      "All ranks read the mesh and write the results if it is\n"
      "- a .vtu file of one piece with raw appended data, compressed or not,\n"
      "- a .vtkhdf file of one partition without chunks,\n"
      "- without --pieces, an .xdmf file of one mesh of one cell type, with its .h5 file without chunks,\n"
      "- with --pieces and without -o, an Exodus file.\n"
      "Rank 0 reads and writes other files, and any file with --ids, --only, --strict or --points, or if\n"
      "-o has another extension.");
  subcommand.footer(
      "Examples:\n"
      "  mpirun -n 4 meshorder order part.vtu -o ordered.vtu\n"
      "  mpirun -n 4 meshorder order part.msh -o ordered.vtu --parts 64 --maps part\n"
      "  mpirun -n 4 meshorder order part.vtu --pieces out --parts 64 --interface last");
  const auto arguments = std::make_shared<Arguments>();
  arguments->is_started_as_rank = is_started_as_rank;
  subcommand.add_option("MESH", arguments->input, "Mesh file")->required();
  subcommand.add_option("-o,--output", arguments->output,
                        "File to write; may be the input, and may be left out with --pieces");
  CLI::Option* const pieces =
      subcommand
          .add_option(
              "--pieces", arguments->pieces,
              "Also write the parts as pieces for a program that reads one for each of its ranks:\n"
              "FOLDER/NAME.pvtu and FOLDER/NAME_0000.vtu and so on, with numbers in the whole mesh, the\n"
              "part that owns each vertex and cell, and ghosts marked as VTK does. NAME is that of the\n"
              "output, or of MESH. The folder is made if it is missing. FILE.vtkhdf is one file with a\n"
              "partition for each part, with the same arrays. FILE.e, .exo, .ex2 or .g gives pieces in\n"
              "Nemesis, FILE.e.4.0 to FILE.e.4.3, of Exodus II with communication maps, without ghosts")
          ->type_name("FOLDER|FILE.vtkhdf|FILE.e")
          ->check([](const std::string& folder) {
            return folder.empty() ? std::string("a folder is needed") : std::string();
          });
  CLI::Option* const ghosts =
      subcommand
          .add_option(
              "--ghosts", arguments->ghosts,
              "Layers of ghost cells in pieces: 1 for the cells of other parts that use a vertex of the\n"
              "part, 0 for none, as in Nemesis")
          ->check(in_range(0, 1))
          ->needs(pieces)
          ->capture_default_str();
  add_partition_options(subcommand, *arguments);
  add_points_option(subcommand, arguments->points);
  add_moving_options(subcommand, *arguments, arguments->ids,
                     "; and the part of each vertex and\n"
                     "cell of the output, PREFIX.vertices.parts.npy and PREFIX.cells.parts.npy");
  add_seed_option(subcommand, arguments->order.seed);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments, ghosts, &communicator] {
    if (ghosts->count() == 0 && arguments->has_nemesis_pieces()) arguments->ghosts = 0;
    const int threads = arguments->threads > 0 ? arguments->threads : share_of_cores(communicator);
    with_threads(threads, [&] { run(*arguments, communicator); });
  });
}

}  // namespace meshorder::command
