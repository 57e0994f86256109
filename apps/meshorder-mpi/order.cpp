// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "order.hpp"

#include "base/stopwatch.hpp"
#include "command.hpp"
#include "console.hpp"
#include "distributed/mesh_slice.hpp"
#include "distributed/order.hpp"
#include "distributed/vtu_slices.hpp"
#include "io/format.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "mesh_files.hpp"
#include "ordering/order_cells.hpp"
#include "report.hpp"
#include "shared_output.hpp"
#include "sliced_maps.hpp"
#include "wording.hpp"
#include <meshorder/io.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
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
using distributed::GlobalIndex;
using distributed::VtuSlices;

/// Cells from which the memory of the rank that reads them is worth a warning.
constexpr Index kManyCells = 10'000'000;

struct Arguments : Common, MeshFiles {
  std::string vertices = "auto";
  std::string partition{to_string(distributed::Partitioner::ptscotch)};
  Index parts = 0;
  OrderOptions order;
  std::string ids = "renumber";
};

DistributedOptions options_of(const Arguments& arguments) {
  DistributedOptions options;
  if (arguments.vertices != "auto") options.vertices = arguments.vertices;
  options.partitioner = parse<distributed::Partitioner>(arguments.partition);
  options.parts = arguments.parts;
  options.order = arguments.order;
  return options;
}

/// The mesh at the root, its cells as the output keeps them.
struct Job : MeshToOrder {
  Permutation arranged;  ///< places of the cells as they were read
  Notes notes;
};

Job read_at_root(const Communicator& communicator, const Arguments& arguments) {
  return communicator.at_root([&] {
    check_can_write(arguments);  // fail before the work
    check_holds_ids(format_of(arguments.output), parse<Ids>(arguments.ids));
    Job job;
    static_cast<MeshToOrder&>(job) = read_to_order(arguments, job.notes);
    if (job.mesh.cell_count() > kManyCells) {
      job.notes.push_back(with_commas(job.mesh.cell_count()) +
                          " cells are read and written by rank 0, which has memory for all of them");
    }
    job.arranged = arrange_cells(job.mesh, format_of(arguments.output));
    return job;
  });
}

std::vector<Index> narrowed(const std::vector<GlobalIndex>& numbers) {
  return {numbers.begin(), numbers.end()};
}

/// Fills in the part of each vertex, and of each cell: that of its last vertex, so that parts of cells ascend
/// where cells are sorted by `lexmax`. The mesh is in its new order.
void note_parts(const Mesh& mesh, const std::vector<GlobalIndex>& starts, Maps& maps) {
  maps.vertex_parts.reserve(mesh.points.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) maps.vertex_parts.push_back(part_of(v, starts));
  maps.cell_parts.reserve(mesh.cells.shapes.size());
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto vertices = mesh.cells[c];
    maps.cell_parts.push_back(maps.vertex_parts[*std::max_element(vertices.begin(), vertices.end())]);
  }
}

/// Puts the mesh into its new order and writes it; returns the paths of the maps.
std::vector<std::string> write_at_root(const Arguments& arguments, Job& job,
                                       const std::vector<GlobalIndex>& vertices,
                                       const std::vector<GlobalIndex>& cells,
                                       const std::vector<GlobalIndex>& part_starts) {
  job.maps.vertices = Permutation::from_old_to_new(narrowed(vertices));
  const Permutation places = permutation_within_classes(slot_classes(cell_arrays(job.mesh)), narrowed(cells));
  apply_reordering(job.mesh, job.maps.vertices, places, parse<Ids>(arguments.ids));
  job.maps.cells = job.arranged.then(places);
  if (!arguments.maps.empty()) note_parts(job.mesh, part_starts, job.maps);
  return write_ordered(job, arguments, job.notes);
}

/// Returns the input as all ranks read it; nothing where rank 0 has to: for old numbers and chosen cells, for
/// files of other kinds, and for maps of cells whose nodes a Mesh has in another order.
std::optional<VtuSlices> slices_of(const Communicator& communicator, const Arguments& arguments) {
  const auto is_vtu = [](const std::string& name) {
    return std::filesystem::path(name).extension() == ".vtu";
  };
  const Keeping& keeping = arguments.keeping;
  if (!is_vtu(arguments.input) || !is_vtu(arguments.output) || arguments.ids != "renumber" ||
      keeping.dimension >= 0 || keeping.strict) {
    return std::nullopt;
  }
  communicator.at_root([&] { check_can_write(arguments); });  // fail before the work
  std::optional<VtuSlices> slices = VtuSlices::open(communicator, arguments.input);
  if (slices && !arguments.maps.empty() && !slices->has_nodes_as_a_mesh(communicator)) slices.reset();
  return slices;
}

/// Writes the mesh in its new order and its maps by all ranks, to files that take their places when they are
/// complete; returns the paths of the maps.
std::vector<std::string> write_slices(const Communicator& communicator, const Arguments& arguments,
                                      const VtuSlices& slices, const DistributedOrder& order,
                                      const MeshChecksums& before, Notes& notes) {
  OutputSet outputs;
  SharedOutput file(communicator, outputs, arguments.output);
  const std::vector<GlobalIndex> new_cells = slices.write(communicator, file.path(), arguments.output, order);
  file.commit();
  std::vector<std::string> maps;
  if (!arguments.maps.empty()) {
    const std::optional<VtuSlices> written = VtuSlices::open(communicator, file.path());
    maps = write_sliced_maps(communicator, {order.new_vertices, new_cells, order.report.part_starts}, before,
                             written->read(communicator), arguments.maps, outputs);
  }
  communicator.at_root([&] {
    outputs.commit();
    notes.insert(notes.end(), outputs.notes().begin(), outputs.notes().end());
  });
  return maps;
}

void run(const Arguments& arguments, const Communicator& communicator) {
  const DistributedOptions options = options_of(arguments);
  const Stopwatch reading;
  const std::optional<VtuSlices> slices = slices_of(communicator, arguments);
  Job job;
  if (!slices) job = read_at_root(communicator, arguments);
  distributed::MeshSlice slice =
      slices ? slices->read(communicator) : distributed::scattered(communicator, job.mesh);
  const GlobalIndex vertex_count = slice.vertices.size();
  const GlobalIndex cell_count = slice.cells.size();
  MeshChecksums before;
  if (slices && !arguments.maps.empty()) before = checksums_of(communicator, slice);
  const double read_seconds = reading.seconds();

  DistributedOrder order = distributed::order_slices(communicator, std::move(slice), options);
  const Stopwatch writing;
  std::vector<std::string> map_files;
  if (slices) {
    map_files = write_slices(communicator, arguments, *slices, order, before, job.notes);
  } else {
    const std::vector<GlobalIndex> vertices = communicator.gathered_at_root(order.new_vertices);
    const std::vector<GlobalIndex> cells = communicator.gathered_at_root(order.cells);
    map_files = communicator.at_root(
        [&] { return write_at_root(arguments, job, vertices, cells, order.report.part_starts); });
  }

  distributed::DistributedReport& report = order.report;
  report.seconds.insert(report.seconds.begin(), {"read", read_seconds});
  report.seconds.emplace_back("write", writing.seconds());
  const std::vector<std::int64_t> peaks = communicator.gathered(peak_memory());
  communicator.at_root([&] {
    Console console(arguments);
    if (!report.partition_reason.empty())
      job.notes.push_back(report.partition_reason + ": parts are ranges of Hilbert's curve");
    console.warn_of(job.notes);
    print_report(console, options, report, peaks);
    console.print("{:<10} {}{}", "wrote", arguments.output, slices ? ", read and written by all ranks" : "");
    for (const std::string& file : map_files) console.print("{:<10} {}", "", file);
    nlohmann::ordered_json result{{"input", arguments.input},
                                  {"output", arguments.output},
                                  {"files_by", slices ? "all ranks" : "rank 0"},
                                  {"vertices", {{"count", vertex_count}, {"method", options.vertices}}},
                                  {"cells", {{"count", cell_count}, {"method", "lexmax"}}}};
    result.update(to_json(report, peaks));
    result["maps"] = map_files;
    console.print_json(std::move(result));
    flush_stdout();
  });
}

/// Threads of this rank: its share of the machine's cores.
int share_of_cores(const Communicator& communicator) {
  return std::max(
      1, static_cast<int>(std::thread::hardware_concurrency()) / communicator.ranks_on_this_machine());
}

}  // namespace

void add_distributed_order(CLI::App& subcommand, const Communicator& communicator) {
  subcommand.description(
      "Reorder a mesh by all ranks: parts, each in an order of its own, numbered one after another, so\n"
      "that parts that touch are near each other. A .vtu file of one piece with raw appended data,\n"
      "compressed or not, is read and written by all ranks, and its maps, unless --ids, --only or\n"
      "--strict are given; others by rank 0.");
  subcommand.footer(
      "Examples:\n"
      "  mpirun -n 4 meshorder order part.vtu -o ordered.vtu\n"
      "  mpirun -n 4 meshorder order part.msh -o ordered.vtu --parts 64 --maps part");
  const auto arguments = std::make_shared<Arguments>();
  subcommand.add_option("MESH", arguments->input, "Mesh file")->required();
  subcommand.add_option("-o,--output", arguments->output, "File to write; may be the input")->required();
  subcommand
      .add_option("--vertices", arguments->vertices,
                  "Method for the vertices of a part, see `meshorder methods`; `auto` is spectral")
      ->capture_default_str();
  subcommand.add_option("--parts", arguments->parts, "Number of parts; 0: as many as ranks")
      ->check(whole_from(0))
      ->capture_default_str();
  subcommand
      .add_option("--partition", arguments->partition,
                  "What makes the parts: `ptscotch` has few edges between them, `hilbert` cuts Hilbert's\n"
                  "curve and gives the same parts on any number of ranks")
      ->check(CLI::IsMember({"ptscotch", "hilbert"}))
      ->capture_default_str();
  add_ids_option(subcommand, arguments->ids);
  add_keeping_options(subcommand, arguments->keeping);
  subcommand.add_option(
      "--maps", arguments->maps,
      "Also write the permutations as NumPy files, by which `meshorder apply` moves or puts\n"
      "back, as `meshorder order` does, and the part of each vertex and cell of the output,\n"
      "PREFIX.vertices.parts.npy and PREFIX.cells.parts.npy");
  subcommand.add_option("--seed", arguments->order.seed, "Seed of random start vectors and of METIS")
      ->check(whole_from(0, std::numeric_limits<std::uint64_t>::max()))
      ->capture_default_str();
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments, &communicator] {
    const int threads = arguments->threads > 0 ? arguments->threads : share_of_cores(communicator);
    with_threads(threads, [&] { run(*arguments, communicator); });
  });
}

}  // namespace meshorder::command
