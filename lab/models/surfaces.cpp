// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/models/surfaces.hpp"

#include "lab/models/cache.hpp"
#include "lab/support/process.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <array>
#include <system_error>

namespace meshorder::models {
namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 3> kSurfaces{"ChineseDragon-10kv.off", "armadillo.off", "bunny00.off"};

fs::path surfaces_folder() { return cache_folder() / "surfaces"; }

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

/// Downloads the package into `folder`. The system's package lists may be missing or old, and only root may
/// update them, so a second attempt uses lists of its own.
void download_package(std::string_view model, const fs::path& folder) {
  try {
    run_tool(model, "apt-get", {"download", "libcgal-demo"}, folder);
  } catch (const InputError&) {
    const std::string lists = "Dir::State::Lists=" + (folder / "lists").string();
    const std::string cache = "Dir::Cache=" + (folder / "cache").string();
    make_folder(folder / "lists/partial");
    make_folder(folder / "cache/archives/partial");
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

}  // namespace

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

void require_tools(std::string_view model, const std::vector<std::string_view>& programs) {
  for (const std::string_view program : programs) (void)require_tool(model, program);
}

fs::path surface_file(std::string_view surface) { return surfaces_folder() / surface; }

void fetch_surfaces(std::string_view model) {
  const fs::path folder = surfaces_folder();
  make_folder(folder);
  const MakingLock lock(folder, "surfaces");
  bool complete = true;
  for (const std::string_view surface : kSurfaces) complete = complete && fs::exists(folder / surface);
  if (complete) return;  // another process was faster

  require_tools(model, {"apt-get", "dpkg-deb", "tar"});
  const ScratchFolder scratch(folder, "surfaces");
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

}  // namespace meshorder::models
