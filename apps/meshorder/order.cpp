// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/stopwatch.hpp"
#include "command.hpp"
#include "console.hpp"
#include "io/format.hpp"
#include "io/stream/output_file.hpp"
#include "maps.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "metrics/edge_span.hpp"
#include "progress.hpp"
#include "wording.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>

namespace meshorder::command {
namespace {

struct OrderArguments : Common {
  std::string input;
  std::string output;
  std::string maps;
  ReorderingOptions reordering;
};

void print_result(const Console& console, const Reordering& order, const EdgeSpan& before,
                  const EdgeSpan& after) {
  const auto print_method = [&](const char* of, const MethodChoice& method, double seconds) {
    console.print("{:<10} {:<14} {}", of, method_in_words(method), duration(seconds));
    if (!method.reason.empty()) console.print("{:<10} {}", "", method.reason);
  };
  print_method("vertices", order.vertex_method, order.vertex_seconds);
  print_method("elements", order.element_method, order.element_seconds);
  if (order.groups) console.print("{:<10} {}", "groups", groups_in_words(*order.groups));
  console.print("{:<10} mean {:.1f} → {:.1f}, largest {} → {}, mean log2 {:.2f} → {:.2f}", "edge span",
                before.mean, after.mean, with_commas(before.max), with_commas(after.max), before.mean_log2,
                after.mean_log2);
}

/// Returns {"count", "method", "chosen_by", "because", "seconds"}.
nlohmann::ordered_json half_json(Index count, const MethodChoice& method, double seconds) {
  nlohmann::ordered_json result{{"count", count}};
  result.update(to_json(method));
  result["seconds"] = seconds;
  return result;
}

void run(const OrderArguments& arguments) {
  const Console console(arguments);
  const Format& target = format_of(arguments.output);
  (void)OutputFile(arguments.output);  // fail before the work if it cannot be written

  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.4);
  const Stopwatch reading;
  Notes notes;
  Mesh mesh = read_mesh(arguments.input, &notes);
  const double read_seconds = reading.seconds();

  progress.stage("ordering", 0.4, 0.7);
  const Stopwatch ordering;
  Maps maps;
  maps.vertex_ids = mesh.vertex_ids;
  maps.cell_ids = mesh.cell_ids;
  const Permutation arranged = arrange_cells(mesh, format_of(arguments.input), target);
  const CsrGraph graph = vertex_graph(mesh);
  const Reordering order = compute_reordering(mesh, graph, arguments.reordering);
  apply_reordering(mesh, order.vertices, order.cells);
  const double order_seconds = ordering.seconds();
  maps.vertices = order.vertices;
  maps.cells = arranged.then(order.cells);
  const EdgeSpan before = edge_span(graph, Permutation::identity(mesh.vertex_count()));
  const EdgeSpan after = edge_span(graph, order.vertices);
  note_convergence(order.vertex_fiedler, "the vertices", notes);
  note_convergence(order.element_fiedler, "the elements", notes);

  progress.stage("writing " + arguments.output, 0.7, 1);
  const Stopwatch writing;
  write_mesh(mesh, arguments.output, &notes);
  std::vector<std::string> map_files;
  if (!arguments.maps.empty()) map_files = write_maps(maps, arguments.maps);
  const double write_seconds = writing.seconds();

  progress.finish();
  console.log_notes(notes);
  print_result(console, order, before, after);
  console.print("{:<10} {}", "wrote", arguments.output);
  for (const std::string& file : map_files) console.print("{:<10} {}", "", file);
  nlohmann::ordered_json result{
      {"input", arguments.input},
      {"output", arguments.output},
      {"vertices", half_json(mesh.vertex_count(), order.vertex_method, order.vertex_seconds)},
      {"elements", half_json(mesh.cell_count(), order.element_method, order.element_seconds)},
      {"for", to_string(arguments.reordering.ordering.workload)},
      {"group_by", order.groups ? to_json(*order.groups) : nullptr},
      {"edge_span", {{"before", to_json(before)}, {"after", to_json(after)}}},
      {"fiedler", to_json(order.vertex_fiedler)},
      {"element_fiedler", to_json(order.element_fiedler)},
      {"maps", map_files},
      {"seconds", {{"read", read_seconds}, {"order", order_seconds}, {"write", write_seconds}}}};
  console.print_json(result);
}

}  // namespace

void add_order(CLI::App& app) {
  CLI::App* subcommand = app.add_subcommand(
      "order",
      "Reorder a mesh with all its data, labels and groups. The extension of the output is its format.");
  subcommand->footer(
      "Examples:\n"
      "  meshorder order dragon.veg -o ordered.veg\n"
      "  meshorder order part.msh -o part.vtu --for spmv --maps part");
  const auto arguments = std::make_shared<OrderArguments>();
  subcommand->add_option("MESH", arguments->input, "Mesh file")->required();
  subcommand->add_option("-o,--output", arguments->output, "File to write; may be the input")->required();
  subcommand
      ->add_option("--vertices", arguments->reordering.vertices,
                   "Method for vertices, see `meshorder methods`")
      ->capture_default_str();
  subcommand
      ->add_option("--elements", arguments->reordering.elements,
                   "Method for elements, see `meshorder methods`")
      ->capture_default_str();
  subcommand
      ->add_option(
          "--group-by", arguments->reordering.group_by,
          "Keep groups together: an array of integers that `meshorder info` lists, or `sets`.\n"
          "`label` is the file's own cell tag (Gmsh's first physical group, Medit's reference);\n"
          "gmsh:geometrical: Gmsh's entities; attribute: TetGen's regions; sets: Vega's regions and\n"
          "named physical groups. Cells are sorted by value, each group in the methods' order; a\n"
          "vertex goes with the smallest value among its elements. An array on vertices groups only\n"
          "the vertices. Write cells:NAME or vertices:NAME if both have that array (default: cells).\n"
          "Cells and vertices without a value come last")
      ->type_name("NAME");
  subcommand->add_option(
      "--maps", arguments->maps,
      "Also write the permutations as NumPy files: PREFIX.vertices.old_to_new.npy and so on");
  add_ordering_options(*subcommand, arguments->reordering.ordering);
  add_common(*subcommand, *arguments);
  subcommand->callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
