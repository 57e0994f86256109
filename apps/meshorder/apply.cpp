// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "command.hpp"
#include "confinement.hpp"
#include "console.hpp"
#include "io/format.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_set.hpp"
#include "maps.hpp"
#include "mesh/reorder.hpp"
#include "mesh_files.hpp"
#include "progress.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>

namespace meshorder::command {
namespace {

struct ApplyArguments : Common {
  std::string prefix;
  std::string input;
  std::string output;
  std::string ids = "renumber";
  bool inverse = false;
  Keeping keeping;
};

void run(const ApplyArguments& arguments) {
  Console console(arguments);
  const Stopwatch total;
  const Ids ids = parse<Ids>(arguments.ids);
  check_holds_ids(output_format_of(arguments.output), ids);
  (void)OutputFile(arguments.output);  // fail before the work if the file cannot be written
  confine({.meshes = {arguments.input}, .maps_read = arguments.prefix, .outputs = {arguments.output}});

  Progress progress(!console.quiet());
  progress.stage("reading " + arguments.input, 0, 0.5);
  Notes notes;
  Mesh mesh = read_input(arguments.input, notes);
  const Format& format = output_format_of(arguments.output, mesh.format);
  leave_out_unmapped_cells(arguments.prefix, mesh, notes);
  const Maps maps = read_maps(arguments.prefix, mesh, arguments.input, arguments.inverse);
  try {
    if (arguments.inverse) {
      undo_reordering(mesh, format, maps.vertices, maps.cells);
    } else {
      apply_reordering(mesh, format, maps.vertices, maps.cells, ids);
    }
  } catch (const InvalidArgument& error) {
    throw InputError(arguments.input, error.what(), "give the maps that were written with this mesh");
  }
  if (arguments.inverse) {
    // restore the ids that the file had before it was ordered
    if (!maps.vertex_ids.empty()) mesh.vertex_ids = maps.vertex_ids;
    if (!maps.cell_ids.empty()) mesh.cell_ids = maps.cell_ids;
  }

  (void)keep_wanted(mesh, arguments.input, arguments.keeping.dimension, notes);

  progress.stage("writing " + arguments.output, 0.5, 1);
  check_mesh(mesh);
  OutputSet outputs;
  (void)write_mesh_to(mesh, {arguments.output, outputs},
                      {.strict = arguments.keeping.strict, .notes = &notes});
  const std::vector<std::string> files = files_of_mesh(outputs, arguments.output);
  outputs.commit();
  notes.insert(notes.end(), outputs.notes().begin(), outputs.notes().end());
  progress.finish();
  console.warn_of(notes);
  console.print("wrote {}: {} vertices and {} cells {}", join(files), with_commas(mesh.vertex_count()),
                with_commas(mesh.cell_count()),
                arguments.inverse ? "restored to the old order" : "reordered");
  console.print_json({{"input", arguments.input},
                      {"output", arguments.output},
                      {"files", files},
                      {"inverse", arguments.inverse},
                      {"vertices", mesh.vertex_count()},
                      {"cells", mesh.cell_count()},
                      {"seconds", total.seconds()}});
}

}  // namespace

void add_apply(CLI::App& subcommand) {
  subcommand.description("Reorder a mesh by the maps that `order --maps` wrote, or restore its old order.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder order a.msh -o ordered.msh --maps a\n"
      "  meshorder apply a a-with-loads.msh -o ordered-with-loads.msh\n"
      "  meshorder apply a ordered.msh -o a-again.msh --inverse");
  const auto arguments = std::make_shared<ApplyArguments>();
  subcommand.add_option("PREFIX", arguments->prefix, "Prefix of the maps, as given to `order --maps`")
      ->required();
  subcommand
      .add_option("MESH", arguments->input, "Mesh file: in its old order or, with --inverse, reordered")
      ->required();
  subcommand.add_option("-o,--output", arguments->output, "File to write; may be the input")->required();
  CLI::Option* const inverse =
      subcommand.add_flag("--inverse", arguments->inverse, "Restore the old order, with the old ids");
  add_ids_option(subcommand, arguments->ids)->excludes(inverse);
  add_keeping_options(subcommand, arguments->keeping);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
