// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "command.hpp"
#include "console.hpp"
#include "io/openfoam/cell_order.hpp"
#include "io/openfoam/poly_mesh.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/scratch.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/judgement.hpp"
#include "ordering/method.hpp"
#include "payoff/advice.hpp"
#include "progress.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>
#include <meshorder/registry.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

struct OpenFoamArguments : Common {
  OpenFoamArguments() {
    // solvers with DIC iterate least and run fastest in Cuthill-McKee's orders (docs/hosts.md)
    ordering.workload = Workload::bandwidth;
  }

  std::string input;
  std::string cells = "auto";
  OrderOptions ordering;
  std::string region;
  std::string time;
  bool parallel = false;
  bool force = false;
  bool dry_run = false;
};

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

/// Returns the names of all folders in a folder, sorted.
std::vector<std::string> folders_in(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, ignored)) {
    if (is_folder(entry.path())) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A case, and those of its meshes that are to be ordered.
class Case {
 public:
  explicit Case(const OpenFoamArguments& arguments)
      : folder_(openfoam::case_folder(arguments.input)),
        region_(arguments.region),
        time_(arguments.time),
        parallel_(arguments.parallel) {
    if (!is_folder(folder_)) refuse_file(folder_);
    find_meshes();
  }

  /// Returns the names of the meshes: "processor3", or empty for the mesh of the whole case.
  [[nodiscard]] const std::vector<std::string>& meshes() const noexcept { return meshes_; }
  /// Returns the folder with a mesh's files.
  [[nodiscard]] fs::path poly_mesh(const std::string& mesh) const { return instance(mesh) / "polyMesh"; }
  /// Returns the file in which renumberMesh expects a mesh's order.
  [[nodiscard]] fs::path cell_order(const std::string& mesh) const {
    return instance(mesh) / openfoam::kCellOrder;
  }
  [[nodiscard]] fs::path dictionary() const { return folder_ / "system" / region_ / "renumberMeshDict"; }
  [[nodiscard]] std::string path() const { return folder_.string(); }
  /// Returns a file to be written in the case.
  [[nodiscard]] FilePath output(const fs::path& file) const { return FilePath::in(folder_, file); }

  /// Returns the command that moves the cells. If the dictionary asks for another order, the text first says
  /// to change it.
  [[nodiscard]] std::string next(bool keeps_other_dictionary) const {
    std::string command = "renumberMesh";
    if (parallel_) command = fmt::format("mpirun -np {} renumberMesh -parallel", meshes_.size());
    command += " -case " + in_shell(folder_.string());
    if (!region_.empty()) command += " -region " + in_shell(region_);
    if (!time_.empty()) command += " -time " + in_shell(time_);
    // without the region: renumberMesh itself looks in the region's folder of the case
    command += " -overwrite -dict system/renumberMeshDict";
    if (!keeps_other_dictionary) return command;
    return fmt::format("change {}, which requests another order; then {}", dictionary().string(), command);
  }

  /// Returns warnings on several time folders, and on meshes in them that are not ordered.
  [[nodiscard]] Notes warnings() const {
    Notes notes;
    std::vector<std::string> times = folders_in(folder_ / meshes_.front());
    std::erase_if(times, [](const std::string& name) {
      return name.find_first_not_of("0123456789.e-+") != std::string::npos || name.front() == '.';
    });
    if (times.size() > 1) {
      notes.push_back(
          fmt::format("the case has folders of {} times; renumberMesh moves only the fields of the time at "
                      "which the case starts: remove the other folders first, or they stay in the old order",
                      times.size()));
    }
    std::erase_if(times, [&](const std::string& name) {
      return !has_owners(folder_ / meshes_.front() / name / region_ / "polyMesh");
    });
    if (time_.empty() && !times.empty()) {
      notes.push_back("the mesh of `constant` is ordered; there are others for the times " + join(times) +
                      ", which --time orders");
    }
    return notes;
  }

 private:
  [[nodiscard]] fs::path instance(const std::string& mesh) const {
    return (folder_ / mesh / (time_.empty() ? "constant" : time_) / region_).lexically_normal();
  }

  static bool has(const fs::path& poly_mesh, const std::string& file) {
    return fs::exists(poly_mesh / file) || fs::exists(poly_mesh / (file + ".gz"));
  }
  static bool has_owners(const fs::path& poly_mesh) { return has(poly_mesh, "owner"); }

  /// Throws InputError for a path that is no folder.
  [[noreturn]] static void refuse_file(const fs::path& path) {
    if (!fs::exists(path)) throw InputError(path.string(), "no such folder", "give an OpenFOAM case");
    throw InputError(path.string(), "is a file, not an OpenFOAM case",
                     "order a mesh file with meshorder order " + in_shell(path.string()));
  }

  /// Throws InputError if a folder is within a case.
  static void refuse_part(const fs::path& folder) {
    const fs::path whole = fs::absolute(folder).lexically_normal();
    for (fs::path outer = whole; outer != outer.parent_path(); outer = outer.parent_path()) {
      if (!openfoam::is_case(outer)) continue;
      const fs::path given = folder.is_absolute() ? outer : outer.lexically_proximate(fs::current_path());
      throw InputError(folder.string(), "is a folder of an OpenFOAM case",
                       "give the case: meshorder openfoam " + in_shell(given.string()));
    }
  }

  void find_meshes() {
    if (parallel_) {
      for (std::size_t p = 0; is_folder(folder_ / fmt::format("processor{}", p)); ++p) {
        meshes_.push_back(fmt::format("processor{}", p));
      }
      if (meshes_.empty()) refuse_parallel();
      check_processors();
    } else {
      meshes_.emplace_back();
    }
    const auto missing = std::find_if(meshes_.begin(), meshes_.end(),
                                      [&](const std::string& mesh) { return !has_owners(poly_mesh(mesh)); });
    if (missing != meshes_.end()) refuse_missing(poly_mesh(*missing));
  }

  /// Throws InputError if a processor's folder exists but a folder with a lower number is missing.
  void check_processors() const {
    constexpr std::string_view kProcessor = "processor";
    for (const std::string& name : folders_in(folder_)) {
      const bool is_numbered = name.starts_with(kProcessor) && name.size() > kProcessor.size() &&
                               name.find_first_not_of("0123456789", kProcessor.size()) == std::string::npos;
      if (!is_numbered || std::find(meshes_.begin(), meshes_.end(), name) != meshes_.end()) continue;
      throw InputError((folder_ / fmt::format("{}{}", kProcessor, meshes_.size())).string(),
                       "the folder is missing, but " + name + " exists", "run decomposePar again");
    }
  }

  [[noreturn]] void refuse_parallel() const {
    for (const std::string& name : folders_in(folder_)) {
      if (!name.starts_with("processors")) continue;
      throw InputError((folder_ / name).string(), "holds the meshes of all processors in common files",
                       "write separate files with decomposePar -fileHandler uncollated");
    }
    throw InputError(folder_.string(), "has no folder processor0", "run decomposePar first");
  }

  [[noreturn]] void refuse_missing(const fs::path& poly_mesh) const {
    if (has(poly_mesh, "neighbour") || has(poly_mesh, "faces")) openfoam::refuse_missing(poly_mesh / "owner");
    if (!openfoam::is_case(folder_)) refuse_part(folder_);
    std::string remedy = "make the mesh first, for instance with blockMesh";
    std::vector<std::string> regions = folders_in(poly_mesh.parent_path());
    std::erase_if(regions, [&](const std::string& region) {
      return !has_owners(poly_mesh.parent_path() / region / "polyMesh");
    });
    if (!region_.empty() || !time_.empty()) {
      remedy = "check --region and --time";
    } else if (!regions.empty()) {
      remedy = "give --region, which may be " + join(regions);
    } else if (!parallel_ && is_folder(folder_ / "processor0")) {
      remedy = "the case is decomposed: give --parallel";
    }
    throw InputError(poly_mesh.string(), "there is no mesh", remedy);
  }

  fs::path folder_;
  std::string region_;
  std::string time_;
  bool parallel_;
  std::vector<std::string> meshes_;
};

/// A mesh and its order.
struct OrderedMesh {
  std::string name;
  Index cells = 0;
  Index internal_faces = 0;
  Order order;
  EdgeSpan before;
  EdgeSpan after;
  Offset profile_before = 0;
  Offset profile_after = 0;
};

/// Returns whether a method uses the centres of cells.
bool needs_centres(const std::string& method, Workload workload) {
  if (method == "auto") return is_judged_by_kernels(workload);  // otherwise `auto` uses only the graph
  return needs_points(vertex_methods(), method);
}

/// Returns a sentence if a method requested by name does not improve the order; else an empty text.
std::string no_better(GraphRef graph, const Permutation& order, const std::string& method) {
  if (method == "auto" || method == "original" || method == "scrambled") return {};
  const std::string reason = reason_to_keep(graph, order, method, made_for(method));
  return reason.empty() ? reason : reason + "; --cells original keeps the order";
}

OrderedMesh ordered(const Case& meshes, const std::string& name, const OpenFoamArguments& arguments,
                    Notes& notes) {
  const openfoam::PolyMesh mesh =
      openfoam::read_poly_mesh(meshes.path(), meshes.poly_mesh(name),
                               needs_centres(arguments.cells, arguments.ordering.workload), notes);
  OrderedMesh result;
  result.name = name;
  result.cells = mesh.graph.size();
  result.internal_faces = mesh.internal_faces;
  const Permutation as_is = Permutation::identity(result.cells);
  PointsView centres;
  if (!mesh.centres.empty()) centres = {mesh.centres.front().data(), mesh.centres.size()};
  result.order = order_vertices({.offsets = mesh.graph.offsets, .neighbours = mesh.graph.neighbours},
                                arguments.cells, arguments.ordering, centres);
  result.before = edge_span(mesh.graph, as_is);
  result.after = edge_span(mesh.graph, result.order.permutation);
  result.profile_before = profile(mesh.graph, as_is);
  result.profile_after = profile(mesh.graph, result.order.permutation);
  if (const std::string note = no_better(mesh.graph, result.order.permutation, arguments.cells);
      !note.empty()) {
    notes.push_back(name.empty() ? note : name + ": " + note);
  }
  note_convergence(result.order.fiedler, "the cells", notes);
  return result;
}

/// The files to be written: the maps, and the dictionary unless an existing dictionary stays.
class Outputs {
 public:
  /// Throws, before the work, if the files cannot be written.
  Outputs(const Case& meshes, bool force) {
    for (const std::string& mesh : meshes.meshes()) maps_.push_back(meshes.output(meshes.cell_order(mesh)));
    const fs::path dictionary = meshes.dictionary();
    const bool is_there = fs::exists(dictionary) && !force;
    if (!is_there) dictionary_ = meshes.output(dictionary);
    keeps_other_ = is_there && !openfoam::takes_cell_order(meshes.output(dictionary));
    for (const FilePath& map : maps_) (void)OutputFile(map);
    if (dictionary_) {
      (void)OutputFile(*dictionary_);
    } else if (!fs::is_symlink(dictionary.parent_path())) {
      remove_dead_scratches(dictionary.parent_path());  // removes what a killed run left
    }
  }

  /// Returns whether the case keeps a dictionary that requests another order.
  [[nodiscard]] bool keeps_other_dictionary() const noexcept { return keeps_other_; }

  /// Writes all files, or none; returns their paths.
  [[nodiscard]] std::vector<std::string> write(const std::vector<OrderedMesh>& meshes) const {
    std::vector<OutputFile> files;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      openfoam::write_cell_order(meshes[m].order.permutation, files.emplace_back(maps_[m]));
      files.back().close();  // there may be more processors than files that may be open at once
    }
    if (dictionary_) openfoam::write_dictionary(files.emplace_back(*dictionary_));
    std::vector<std::string> paths;
    paths.reserve(files.size());
    for (const OutputFile& file : files) paths.push_back(file.target().string());
    OutputFile::commit_all(files);
    return paths;
  }

 private:
  std::vector<FilePath> maps_;
  std::optional<FilePath> dictionary_;
  bool keeps_other_ = false;
};

bool all_stay(const std::vector<OrderedMesh>& meshes) {
  return std::all_of(meshes.begin(), meshes.end(),
                     [](const OrderedMesh& mesh) { return mesh.order.permutation.is_identity(); });
}

/// Prints a line on the mesh of a processor.
void print_part(const Console& console, const OrderedMesh& mesh) {
  console.print("{:<12} {} cells, {}: band {} → {}, profile {} → {}", mesh.name, with_commas(mesh.cells),
                method_in_words(mesh.order.method), with_commas(mesh.before.max), with_commas(mesh.after.max),
                with_commas(mesh.profile_before), with_commas(mesh.profile_after));
}

/// Prints a table on the mesh of the whole case.
void print_mesh(const Console& console, const OrderedMesh& mesh) {
  const MethodChoice& method = mesh.order.method;
  console.print("{:<10} {} with {} internal faces", "cells", with_commas(mesh.cells),
                with_commas(mesh.internal_faces));
  console.print("{:<10} {:<14} {}", "order", method_in_words(method), duration(mesh.order.seconds));
  if (!method.reason.empty()) console.print("{:<10} {}", "", method.reason);
  const auto row = [&](const char* name, const std::string& before, const std::string& after) {
    console.print("{:<10} {:<14} {:>20} {:>20}", "", name, before, after);
  };
  row("", "before", "after");
  row("band", with_commas(mesh.before.max), with_commas(mesh.after.max));
  row("profile", with_commas(mesh.profile_before), with_commas(mesh.profile_after));
  row("mean span", fmt::format("{:.1f}", mesh.before.mean), fmt::format("{:.1f}", mesh.after.mean));
  row("mean log2 span", fmt::format("{:.2f}", mesh.before.mean_log2),
      fmt::format("{:.2f}", mesh.after.mean_log2));
}

nlohmann::ordered_json mesh_json(const Case& meshes, const OrderedMesh& mesh, bool is_written) {
  nlohmann::ordered_json result{{"folder", meshes.poly_mesh(mesh.name).string()},
                                {"cells", mesh.cells},
                                {"internal_faces", mesh.internal_faces}};
  result.update(to_json(mesh.order.method));
  result["kept"] = mesh.order.permutation.is_identity();
  result["edge_span"] = {{"before", to_json(mesh.before)}, {"after", to_json(mesh.after)}};
  result["profile"] = {{"before", mesh.profile_before}, {"after", mesh.profile_after}};
  result["fiedler"] = to_json(mesh.order.fiedler);
  result["seconds"] = mesh.order.seconds;
  result["map"] = or_null(is_written ? meshes.cell_order(mesh.name).string() : "");
  return result;
}

void run(const OpenFoamArguments& arguments) {
  Console console(arguments);
  const Stopwatch stopwatch;
  const Case meshes(arguments);
  std::optional<Outputs> outputs;
  if (!arguments.dry_run) outputs.emplace(meshes, arguments.force);

  Progress progress(!console.quiet());
  Notes notes = meshes.warnings();
  std::vector<OrderedMesh> done;
  for (const std::string& name : meshes.meshes()) {
    const auto count = static_cast<double>(meshes.meshes().size());
    const auto begun = static_cast<double>(done.size());
    progress.stage("ordering " + meshes.poly_mesh(name).string(), begun / count, (begun + 1) / count);
    done.push_back(ordered(meshes, name, arguments, notes));
  }
  std::vector<std::string> written;
  if (outputs) written = outputs->write(done);
  if (outputs && outputs->keeps_other_dictionary()) {
    notes.push_back(meshes.dictionary().string() + " requests another order and is left as it is; put `" +
                    join(openfoam::kDictionaryEntries, std::string_view(" ")) +
                    "` into it, or give --force, which replaces it");
  }
  progress.finish();

  console.warn_of(notes);
  for (const OrderedMesh& mesh : done)
    mesh.name.empty() ? print_mesh(console, mesh) : print_part(console, mesh);
  for (const std::string& file : written) {
    console.print("{:<10} {}", &file == written.data() ? "wrote" : "", file);
  }
  const bool to_be_moved = outputs && !all_stay(done);
  const std::string next = to_be_moved ? meshes.next(outputs->keeps_other_dictionary()) : "";
  if (to_be_moved) {
    console.print("{:<10} {}", "next", next);
    console.print("{:<10} run it once: a second run would move the cells again", "");
  } else if (outputs) {
    console.print("{:<10} nothing: all cells stay where they are", "next");
  }
  auto list = nlohmann::ordered_json::array();
  for (const OrderedMesh& mesh : done) list.push_back(mesh_json(meshes, mesh, outputs.has_value()));
  console.print_json({{"case", meshes.path()},
                      {"for", to_string(arguments.ordering.workload)},
                      {"meshes", list},
                      {"files", written},
                      {"next", or_null(next)},
                      {"seconds", stopwatch.seconds()}});
}

}  // namespace

void add_openfoam(CLI::App& subcommand) {
  subcommand.description(
      "Order the cells of an OpenFOAM case. Writes the order to constant/cellOrder, and a dictionary,\n"
      "system/renumberMeshDict. By these, OpenFOAM's renumberMesh moves the cells with all fields, zones\n"
      "and sets.");
  subcommand.footer(
      "Examples:\n"
      "  meshorder openfoam cavity\n"
      "  meshorder openfoam cavity --cells rcm --dry-run\n"
      "  meshorder openfoam motorBike --parallel");
  const auto arguments = std::make_shared<OpenFoamArguments>();
  subcommand.add_option("CASE", arguments->input, "Folder of the case, or its .foam file")->required();
  subcommand
      .add_option("--cells", arguments->cells,
                  "Method for cells: one of the vertex methods that `meshorder methods` lists")
      ->capture_default_str();
  subcommand.add_option("--region", arguments->region, "Order the mesh of this region")->type_name("NAME");
  subcommand
      .add_option("--time", arguments->time,
                  "Order the mesh of this time, written as in the folder's name, instead of `constant`")
      ->type_name("TIME");
  subcommand.add_flag("--parallel", arguments->parallel,
                      "Order the meshes of a decomposed case, in processor0, processor1, …");
  subcommand.add_flag(
      "--force", arguments->force,
      "Replace a renumberMeshDict that requests another order; without this option it is kept");
  subcommand.add_flag("--dry-run", arguments->dry_run, "Write nothing");
  add_ordering_options(subcommand, arguments->ordering);
  add_reading_options(subcommand);
  add_common(subcommand, *arguments);
  subcommand.callback([arguments] { with_threads(arguments->threads, [&] { run(*arguments); }); });
}

}  // namespace meshorder::command
