// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/models/catalogue.hpp"

#include "base/text.hpp"
#include "io/format.hpp"
#include "lab/models/cache.hpp"
#include "lab/support/process.hpp"
#include "mesh/procedural.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace meshorder {
namespace fs = std::filesystem;

namespace {

// ---- the list

/// How a model is made from a surface; apps/meshorder-models/README.md explains these steps.
struct Recipe {
  std::string_view name;
  std::string_view description;
  std::string_view surface;
  std::string_view tetgen_options;
  double alpha_ratio = 0;  ///< of the wrap, diagonal / alpha; 0: fill the surface as it is
  double offset_ratio = 0;
};

constexpr std::array<Recipe, 4> kRecipes{{
    {"dragon", "the paper's dragon: 46 thousand vertices, all on its surface", "ChineseDragon-10kv.off", "-p",
     216, 2500},
    {"armadillo", "the paper's armadillo: 46 thousand vertices, all on its surface", "armadillo.off", "-p",
     304, 600},
    {"bunny", "the paper's bunny: 35 thousand vertices, all on its surface", "bunny00.off", "-p", 234, 1000},
    {"armadillo-300k", "the armadillo filled evenly: 290 thousand vertices, 1.3 million tetrahedra",
     "armadillo.off", "-pq1.4a2.2"},
}};

struct Rule {
  std::string_view name;
  std::string_view description;
  Mesh (*make)(const ProceduralOptions&);
};

constexpr std::array<Rule, 3> kRules{{
    {"grid", "a cube cut into tetrahedra, in any size, numbered along its rows", make_grid},
    {"ball", "a ball cut into tetrahedra, in any size, numbered along its rows", make_ball},
    {"torus", "a torus cut into tetrahedra, in any size, numbered along its rows", make_torus},
}};

/// Returns 40 for "grid-40" and the rule "grid"; empty for a name without a size, or of another rule.
std::optional<Index> size_in(std::string_view name, const Rule& rule) {
  if (!name.starts_with(rule.name) || name.size() == rule.name.size()) return std::nullopt;
  name.remove_prefix(rule.name.size());
  Index size = 0;
  const char* const end = name.data() + name.size();
  const auto [stopped, error] = std::from_chars(name.data() + 1, end, size);
  if (name.front() != '-' || error != std::errc() || stopped != end || name[1] == '0') return std::nullopt;
  return size;
}

/// Returns a model, with its path and counts if it has been made.
Model look_up(std::string name, std::string_view description, bool procedural) {
  Model model{std::move(name), std::string(description), procedural, {}, 0, 0};
  fs::path path = models_folder() / (model.name + ".node");
  const auto [vertices, elements] = models::counts_of(path);
  if (vertices == 0) return model;
  model.path = std::move(path);
  model.vertices = vertices;
  model.elements = elements;
  return model;
}

std::vector<Index> made_sizes(const Rule& rule) {
  std::vector<Index> sizes;
  std::error_code nothing_made_yet;
  for (const auto& entry : fs::directory_iterator(models_folder(), nothing_made_yet)) {
    if (entry.path().extension() != ".node") continue;
    if (const auto size = size_in(entry.path().stem().string(), rule)) sizes.push_back(*size);
  }
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

// ---- the surfaces

constexpr std::array<std::string_view, 3> kSurfaces{"ChineseDragon-10kv.off", "armadillo.off", "bunny00.off"};

fs::path surfaces_folder() { return models::cache_folder() / "surfaces"; }

std::string model_named(std::string_view model) { return fmt::format("model {}", model); }

std::string how_to_install(std::string_view program) {
  if (program == "meshorder-models") {
    return "build it beside meshorder (the CMake option MESHORDER_MODELS_TOOL) or put it on PATH";
  }
  const std::string_view package = program == "apt-get" ? "apt" : program == "dpkg-deb" ? "dpkg" : program;
  std::string remedy = fmt::format("apt-get install {}", package);
  if (program != "tetgen" && program != "tar") {
    remedy += fmt::format(", or on other systems put {} from CGAL's example data into {}",
                          fmt::join(kSurfaces, ", "), surfaces_folder().string());
  }
  return remedy;
}

fs::path require_tool(std::string_view model, std::string_view program) {
  fs::path path = find_program(program);
  if (path.empty()) {
    throw InputError(model_named(model), fmt::format("{} is not installed", program),
                     how_to_install(program));
  }
  return path;
}

std::string remedy_for_failure(std::string_view program) {
  if (program == "apt-get") return "is there a network, and does apt-get update work?";
  if (program == "tar" || program == "dpkg-deb") return "is the disk full?";
  return "are memory and disk space left?";
}

/// Runs a program that a model needs; the output goes to `folder/log`. Throws Error with the Debian package
/// to install if the program is missing, and with the last line of output if it fails.
void run_tool(std::string_view model, std::string_view program, const std::vector<std::string>& arguments,
              const fs::path& folder) {
  const fs::path path = require_tool(model, program);
  const ExitStatus ended = run_process(path, arguments, folder, folder / "log");
  if (ended.code == 0) return;
  throw InputError(model_named(model),
                   fmt::format("{} failed with status {}: {}", program, ended.code,
                               ended.last_line.empty() ? "it printed nothing" : ended.last_line),
                   remedy_for_failure(program));
}

/// Throws Error if one of the programs is not installed.
void require_tools(std::string_view model, const std::vector<std::string_view>& programs) {
  for (const std::string_view program : programs) (void)require_tool(model, program);
}

/// Downloads the package into `folder`. The system's package lists may be missing or old, and only root may
/// update them, so a second attempt uses lists of its own.
void download_package(std::string_view model, const fs::path& folder) {
  try {
    run_tool(model, "apt-get", {"download", "libcgal-demo"}, folder);
  } catch (const InputError&) {
    const std::string lists = "Dir::State::Lists=" + (folder / "lists").string();
    const std::string cache = "Dir::Cache=" + (folder / "cache").string();
    models::make_folder(folder / "lists/partial");
    models::make_folder(folder / "cache/archives/partial");
    run_tool(model, "apt-get", {"-o", lists, "-o", cache, "update"}, folder);
    run_tool(model, "apt-get", {"-o", lists, "-o", cache, "download", "libcgal-demo"}, folder);
  }
}

/// Returns the package's file name, which includes its version.
std::string downloaded_package(std::string_view model, const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".deb") return entry.path().filename().string();
  }
  throw InputError(model_named(model), "apt-get downloaded no package", remedy_for_failure("apt-get"));
}

/// Returns the path of a surface of CGAL's examples, "armadillo.off"; the file may not exist yet.
fs::path surface_file(std::string_view surface) { return surfaces_folder() / surface; }

/// Downloads Debian's package of CGAL's examples and stores the surfaces of all models. Throws Error if a
/// program is missing or fails, or if there is no network.
void fetch_surfaces(std::string_view model) {
  const fs::path folder = surfaces_folder();
  models::make_folder(folder);
  const models::MakingLock lock(folder, "surfaces");
  bool complete = true;
  for (const std::string_view surface : kSurfaces) complete = complete && fs::exists(folder / surface);
  if (complete) return;  // another process was faster

  require_tools(model, {"apt-get", "dpkg-deb", "tar"});
  const models::ScratchFolder scratch(folder, "surfaces");
  download_package(model, scratch.path());
  run_tool(model, "dpkg-deb", {"--extract", downloaded_package(model, scratch.path()), "demo"},
           scratch.path());
  std::vector<std::string> unpack{"-xzf", "demo/usr/share/doc/libcgal-dev/data.tar.gz",
                                  "--strip-components=2"};
  for (const std::string_view surface : kSurfaces) unpack.push_back(fmt::format("data/meshes/{}", surface));
  run_tool(model, "tar", unpack, scratch.path());
  for (const std::string_view surface : kSurfaces) {
    std::error_code code;
    fs::rename(scratch.path() / surface, folder / surface, code);
    if (code)
      throw InputError((folder / surface).string(), "cannot be written: " + code.message(),
                       "check the folder");
  }
}

// ---- making

using Report = std::function<void(std::string_view, double)>;

// Both functions write a .node and a .ele file into `folder` and return their path without extension.
fs::path make_by_rule(const Rule& rule, Index size, const fs::path& folder, const Report& progress) {
  progress("Building the mesh", 0);
  fs::path path = folder / rule.name;
  write_mesh(rule.make({.size = size}), path.string() + ".node");
  return path;
}

fs::path make_by_recipe(const Recipe& recipe, const fs::path& folder, const Report& progress) {
  const bool wrapped = recipe.alpha_ratio > 0;
  require_tools(recipe.name, {"tetgen"});
  if (wrapped) require_tools(recipe.name, {"meshorder-models"});

  const fs::path surface = surface_file(recipe.surface);
  const bool fetch = !fs::exists(surface);
  if (fetch) {
    progress("Downloading the surface (24 MB, Debian's libcgal-demo)", 0);
    fetch_surfaces(recipe.name);
  }

  const std::string input = fmt::format("{}.off", recipe.name);
  if (wrapped) {
    progress("Wrapping the surface (about 15 s)", fetch ? 0.3 : 0);
    run_tool(recipe.name, "meshorder-models",
             {"wrap", surface.string(), input, "--alpha-ratio", fmt::format("{}", recipe.alpha_ratio),
              "--offset-ratio", fmt::format("{}", recipe.offset_ratio)},
             folder);
  } else {
    fs::copy_file(surface, folder / input);
  }

  progress(fmt::format("Filling it with tetrahedra (TetGen, about {} s)", wrapped ? 1 : 25), wrapped ? 0.95
                                                                                             : fetch ? 0.2
                                                                                                     : 0);
  run_tool(recipe.name, "tetgen", {std::string(recipe.tetgen_options), input}, folder);
  return folder / fmt::format("{}.1", recipe.name);
}

/// Makes a model in the cache, unless another process has made it meanwhile. `make` gets an empty folder.
template <class Make>
void make_kept(const std::string& name, bool force, const Report& progress, const Make& make) {
  const fs::path folder = models_folder();
  models::make_folder(folder);
  const models::MakingLock lock(folder, name);
  if (!force && models::counts_of(folder / (name + ".node")).vertices > 0) return;
  const models::ScratchFolder scratch(folder, name);
  const fs::path made = make(scratch.path());
  if (models::counts_of(made.string() + ".node").vertices == 0) {
    throw InputError("model " + name, "its last step wrote no mesh", "is the disk full?");
  }
  models::publish(made, folder / name);
  progress("Done", 1);
}

[[noreturn]] void refuse_name(std::string_view name) {
  const auto name_of = [](const auto& entry) { return entry.name; };
  throw InvalidArgument(fmt::format("unknown model '{}'; known: {}, {}, and sizes as in grid-40", name,
                                    join(kRecipes, name_of), join(kRules, name_of)));
}

/// Throws InvalidArgument if a size is given; called for a model of fixed size.
void check_size(std::string_view name, const MakeOptions& options) {
  if (!options.size) return;
  throw InvalidArgument(fmt::format("model {}: has a fixed size; leave out --size, which is for {}", name,
                                    join(kRules, [](const Rule& rule) { return rule.name; })));
}

}  // namespace

fs::path models_folder() { return models::cache_folder() / "models"; }

std::vector<Model> list_models() {
  std::vector<Model> result;
  result.reserve(kRecipes.size() + kRules.size());
  for (const Recipe& recipe : kRecipes) {
    result.push_back(look_up(std::string(recipe.name), recipe.description, false));
  }
  for (const Rule& rule : kRules) {
    result.push_back({std::string(rule.name), std::string(rule.description), true, {}, 0, 0});
    for (const Index size : made_sizes(rule)) {
      result.push_back(look_up(fmt::format("{}-{}", rule.name, size),
                               fmt::format("the {} in size {}", rule.name, size), true));
    }
  }
  return result;
}

Model make_model(std::string_view name, const MakeOptions& options) {
  const Report progress = options.progress ? options.progress : [](std::string_view, double) {};
  const auto kept_or_made = [&](Model model, const auto& make) {
    if (!options.force && !model.path.empty()) return model;
    make_kept(model.name, options.force, progress, make);
    return look_up(model.name, model.description, model.procedural);
  };

  for (const Recipe& recipe : kRecipes) {
    if (name != recipe.name) continue;
    check_size(name, options);
    return kept_or_made(look_up(std::string(name), recipe.description, false),
                        [&](const fs::path& folder) { return make_by_recipe(recipe, folder, progress); });
  }
  for (const Rule& rule : kRules) {
    const std::optional<Index> own_size = size_in(name, rule);
    if (name != rule.name && !own_size) continue;
    if (own_size) check_size(name, options);
    const Index size = own_size.value_or(options.size.value_or(kUsualSize));
    return kept_or_made(look_up(fmt::format("{}-{}", rule.name, size),
                                fmt::format("the {} in size {}", rule.name, size), true),
                        [&](const fs::path& folder) { return make_by_rule(rule, size, folder, progress); });
  }
  refuse_name(name);
}

}  // namespace meshorder
