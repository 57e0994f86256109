// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "trial_subject.hpp"

#include "base/text.hpp"
#include "io/format.hpp"
#include "io/stream/file_path.hpp"
#include "ordering/method.hpp"
#include "standard_streams.hpp"
#include "trial_program.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr std::array kOrdersOfMesh{"auto", "hilbert", "rcm", "spectral-fronts", "hilbert-fronts"};
constexpr std::array kOrdersOfMatrix{"auto", "rcm", "spectral-fronts"};
constexpr const char* kRenumberMesh = "renumberMesh";
constexpr std::array kOrdersOfCase{"auto", kRenumberMesh, "bfs", "fiedler", "hilbert"};

/// Throws InvalidArgument for an order whose `method` is neither in `methods` nor equal to `also`. Proposes a
/// method with a similar name, or else `remedy`.
[[noreturn]] void refuse_order(const std::string& order, const std::string& method,
                               const std::vector<MethodInfo>& methods, const std::string& also,
                               const std::string& remedy) {
  std::vector<std::string> names{also};
  for (const MethodInfo& known : methods) names.push_back(known.name);
  const std::string nearest = suggestion(method, names);
  throw InvalidArgument(fmt::format("--methods {}: there is no such order{}", order,
                                    nearest.empty() ? "; " + remedy : nearest));
}

std::string own_program() {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  if (code) throw Unavailable("try: the system does not report where meshorder is (/proc/self/exe)");
  return program.string();
}

/// Runs a program that makes an order. If it fails, throws CommandError with the text of `failure_of`, with
/// `shown` in place of `path`.
TrialRun run_to_order(const TrialCommand& command, const std::string& path, const std::string& shown) {
  TrialRun run = run_program(command);
  if (run.succeeded()) return run;
  constexpr std::string_view kName = "meshorder: ";
  std::string failure = failure_of(run, command);
  const std::size_t at = failure.find(kName);
  if (at != std::string::npos) failure = failure.substr(at + kName.size());
  throw CommandError(replaced(failure, path, shown), kBadInput);
}

nlohmann::json printed(const TrialFolder& folder) {
  return nlohmann::json::parse(FilePath(folder.log().string() + ".out").read());
}

class TriedMesh final : public TrialSubject {
 public:
  TriedMesh(std::string path, OrderingOptions options)
      : path_(std::move(path)), options_(std::move(options)) {
    (void)format_of(path_);
    (void)output_format_of(path_);
    if (!fs::is_regular_file(path_))
      throw InputError(path_, "there is no such file", "give the file of a mesh");
    if (without_gz(path_) != path_)
      throw InputError(path_, "it is compressed, but the reordered files would not be", "gunzip it first");
  }

  [[nodiscard]] std::string name() const override { return fs::path(path_).filename().string(); }
  [[nodiscard]] std::string stem() const override { return fs::path(path_).stem().string(); }

  [[nodiscard]] std::vector<fs::path> originals() const override {
    return {path_, fs::absolute(path_).parent_path()};
  }

  [[nodiscard]] TrialFolder folder(const std::vector<std::string>& with, bool is_protected) const override {
    return {fs::absolute(path_).parent_path(), name(), with, is_protected};
  }

  [[nodiscard]] std::vector<std::string> orders() const override {
    const std::string_view format = format_of(path_).name;
    if (format == "MatrixMarket" || format == "METIS")
      return {kOrdersOfMatrix.begin(), kOrdersOfMatrix.end()};
    return {kOrdersOfMesh.begin(), kOrdersOfMesh.end()};
  }

  void check_order(const std::string& name) const override {
    if (name == "auto") return;
    const MeshMethods methods = order_named(name);
    const std::string remedy = "meshorder methods lists them";
    if (!method_named(vertex_methods(), methods.vertices))
      refuse_order(name, methods.vertices, vertex_methods(), "auto", remedy);
    if (!method_named(element_methods(), methods.elements))
      refuse_order(name, methods.elements, element_methods(), "auto", remedy);
  }

  bool make(TriedOrder& order, TrialFolder& folder, std::size_t number) const override {
    const std::string output = (folder.add_order(number) / name()).string();
    TrialCommand command{
        .words = {own_program(), "order", fs::absolute(path_).string(), "-o", output, "--vertices",
                  order.methods.vertices, "--elements", order.methods.elements, "--ids", options_.ids,
                  "--threads", std::to_string(options_.threads), "--json", "--quiet"},
        .folder = fs::current_path(),
        .log = folder.log()};
    command.words.insert(command.words.end(), options_.words.begin(), options_.words.end());
    (void)run_to_order(command, output, path_);
    const nlohmann::json made = printed(folder);
    for (const auto& seconds : made["seconds"]) order.order_seconds += seconds.get<double>();
    order.made_by = command_for(order);
    if (order.by_auto) {
      order.methods = {made["vertices"]["method"].get<std::string>(),
                       made["cells"]["method"].get<std::string>()};
      order.name = order.methods.vertices;
      if (order.methods.elements != "lexmax") order.name += "/" + order.methods.elements;
    }
    return made["vertices"]["kept"].get<bool>() && made["cells"]["kept"].get<bool>();
  }

 private:
  /// Returns the command that a user can give to make an order.
  [[nodiscard]] std::string command_for(const TriedOrder& order) const {
    std::string command =
        fmt::format("meshorder order {} -o {}", in_shell(path_), in_shell("ordered-" + name()));
    if (!order.by_auto) command += " --vertices " + order.methods.vertices;
    if (!order.by_auto && order.methods.elements != "lexmax")
      command += " --elements " + order.methods.elements;
    if (options_.ids != "renumber") command += " --ids " + options_.ids;
    return command;
  }

  std::string path_;
  OrderingOptions options_;
};

/// Returns whether a folder with this name in a case has meshes of processes: processor0 or processors4.
bool is_of_process(const std::string& name) { return name.starts_with("processor"); }

/// Returns whether a case is decomposed for several processes.
bool is_decomposed(const fs::path& folder) {
  return std::ranges::any_of(fs::directory_iterator(folder), [](const fs::directory_entry& entry) {
    return entry.is_directory() && is_of_process(entry.path().filename().string());
  });
}

/// A case of OpenFOAM; renumberMesh moves its cells.
class TriedCase final : public TrialSubject {
 public:
  TriedCase(const std::string& path, OrderingOptions options)
      : path_(fs::is_directory(path) ? path
                                     : (fs::path(".") / path).parent_path().lexically_normal().string()),
        options_(std::move(options)) {
    if (options_.ids != "renumber") throw InvalidArgument("--ids: a case of OpenFOAM has no such numbers");
    const fs::path mesh = fs::path(path_) / "constant" / "polyMesh";
    if (!fs::exists(mesh / "owner") && !fs::exists(mesh / "owner.gz")) {
      if (is_decomposed(path_))
        throw InputError(path_, "decomposed cases cannot be tried",
                         "reconstruct it first: reconstructParMesh -constant, then reconstructPar");
      throw InputError(mesh.string(), "there is no mesh of OpenFOAM",
                       "give the file of a mesh, or the folder of a case, and make its mesh first");
    }
    try {
      renumber_mesh_ = find_program(kRenumberMesh);
    } catch (const InvalidArgument&) {
      throw InvalidArgument(
          "renumberMesh, which moves the cells, was not found: run OpenFOAM's etc/bashrc first");
    }
  }

  [[nodiscard]] std::string name() const override { return "."; }
  [[nodiscard]] std::string stem() const override {
    return fs::absolute(path_).lexically_normal().filename().string();
  }

  [[nodiscard]] std::vector<fs::path> originals() const override {
    return {path_, fs::path(path_) / "constant", fs::path(path_) / "constant" / "polyMesh"};
  }

  [[nodiscard]] TrialFolder folder(const std::vector<std::string>& with, bool is_protected) const override {
    if (is_decomposed(path_) && (with.empty() || std::ranges::any_of(with, is_of_process))) {
      throw InputError(
          path_,
          "it has a mesh in constant and others in processor folders; only the mesh in constant can be tried",
          "if the program reads this mesh, name the folders that it needs, as in --with 0,constant,system");
    }
    return {path_, "", with, is_protected};
  }

  [[nodiscard]] std::vector<std::string> orders() const override {
    return {kOrdersOfCase.begin(), kOrdersOfCase.end()};
  }

  void check_order(const std::string& name) const override {
    if (name == "auto" || name == kRenumberMesh || method_named(vertex_methods(), name)) return;
    refuse_order(name, name, vertex_methods(), kRenumberMesh,
                 fmt::format("give a vertex method that meshorder methods lists, or {} for its own order",
                             kRenumberMesh));
  }

  bool make(TriedOrder& order, TrialFolder& folder, std::size_t number) const override {
    const std::string copy = folder.add_order(number).string();
    folder.copy_files(number);
    TrialCommand renumber{.words = {renumber_mesh_, "-case", copy, "-overwrite"},
                          .folder = copy,
                          .log = folder.log(),
                          .protection = folder.protection()};
    const std::string own = fmt::format("{} -case {} -overwrite", kRenumberMesh, in_shell(path_));
    bool is_own = false;
    if (order.name == kRenumberMesh) {
      std::error_code ignored;
      fs::remove(fs::path(copy) / "system" / "renumberMeshDict", ignored);
      order.made_by = own;
    } else {
      TrialCommand command{
          .words = {own_program(), "openfoam", copy, "--force", "--cells", order.methods.vertices,
                    "--threads", std::to_string(options_.threads), "--json", "--quiet"},
          .folder = fs::current_path(),
          .log = folder.log()};
      command.words.insert(command.words.end(), options_.words.begin(), options_.words.end());
      (void)run_to_order(command, copy, path_);
      const nlohmann::json made = printed(folder)["meshes"].front();
      order.order_seconds = made["seconds"].get<double>();
      order.made_by =
          fmt::format("meshorder openfoam {}{} && {} -dict system/renumberMeshDict", in_shell(path_),
                      order.by_auto ? "" : " --cells " + order.methods.vertices, own);
      order.methods.vertices = order.name = made["method"].get<std::string>();
      is_own = made["kept"].get<bool>();
      renumber.words.insert(renumber.words.end(), {"-dict", "system/renumberMeshDict"});
    }
    if (!is_own) order.order_seconds += run_to_order(renumber, copy, path_).wall_seconds;
    return is_own;
  }

 private:
  std::string path_;
  OrderingOptions options_;
  std::string renumber_mesh_;
};

}  // namespace

std::unique_ptr<TrialSubject> trial_subject(const std::string& path, OrderingOptions options) {
  if (fs::is_directory(path) || fs::path(path).extension() == ".foam")
    return std::make_unique<TriedCase>(path, std::move(options));
  return std::make_unique<TriedMesh>(path, std::move(options));
}

}  // namespace meshorder::command
