// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/page/study_page.hpp"

#include "io/npy.hpp"
#include "io/stream/output_file.hpp"
#include "lab/report/findings/findings.hpp"
#include "lab/report/tables/tables.hpp"
#include "lab/scenario/motion_file.hpp"
#include "lab/study/results_json.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <map>
#include <optional>
#include <system_error>

namespace meshorder {
namespace {
namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code code;
  return fs::exists(path, code);
}

/// Runs `work` and turns InvalidArgument into an Error that names the file.
template <class Work>
auto naming(const fs::path& path, const Work& work) {
  try {
    return work();
  } catch (const InvalidArgument& error) {
    throw InputError(path.string(), error.what(), "is it of another study?");
  }
}

/// Reports progress, one part of the study after another.
class Parts {
 public:
  Parts(const StudyResults& results, const ReportProgress& progress)
      : progress_(progress), count_(results.meshes.size() + results.scenarios.size() + 1) {}

  void begin(const std::string& what) {
    if (progress_) progress_(what, static_cast<double>(done_) / static_cast<double>(count_));
    ++done_;
  }

 private:
  const ReportProgress& progress_;
  std::size_t count_;
  std::size_t done_ = 0;
};

/// The study's meshes in its folder, by name.
using Meshes = std::map<std::string, Mesh>;

PageMesh mesh_of(const StudyFolder& folder, const StudyResults& results, const MeshRecord& record,
                 const Mesh& mesh, Notes& notes, const PageDetail& detail) {
  std::vector<std::pair<std::string, Permutation>> orders;
  for (const OrderingSpec& ordering : results.orderings) {
    const fs::path path = folder.vertex_order(record.name, ordering.name);
    if (is_there(path)) {
      orders.emplace_back(ordering.name,
                          read_permutation(folder.file(path), mesh.vertex_count(), "vertices"));
    } else {
      notes.push_back(fmt::format("the page does not show {} in the order {}: {} is missing", record.name,
                                  ordering.title, path.string()));
    }
  }
  return naming(folder.mesh(record.name), [&] { return page_mesh(record.name, mesh, orders, detail); });
}

std::optional<PageMotion> motion_of(const StudyFolder& folder, const ScenarioRecord& scenario,
                                    const Meshes& meshes, Notes& notes, const PageDetail& detail) {
  const fs::path path = folder.motion(scenario.name);
  const auto mesh = meshes.find(scenario.mesh);
  if (!is_there(path) || mesh == meshes.end()) {
    notes.push_back(fmt::format("the page does not play {}: {} is missing", scenario.name,
                                (mesh == meshes.end() ? folder.mesh(scenario.mesh) : path).string()));
    return std::nullopt;
  }
  const Motion motion = read_motion(folder.file(path));
  std::optional<Mesh> obstacles;
  if (is_there(folder.obstacles(scenario.name)))
    obstacles = read_mesh_from(folder.file(folder.obstacles(scenario.name)));
  FluidSurfaces surfaces;
  if (scenario.method == "particle-fem" && !is_there(folder.surfaces(scenario.name))) {
    notes.push_back(fmt::format("the page does not play {}: {} is missing", scenario.name,
                                folder.surfaces(scenario.name).string()));
    return std::nullopt;
  }
  if (scenario.method == "particle-fem")
    surfaces =
        read_surfaces(folder.file(folder.surfaces(scenario.name)), motion.frames.size(), motion.vertices);
  return naming(path, [&] {
    return page_motion(scenario, mesh->second, motion, surfaces, obstacles ? &*obstacles : nullptr, detail);
  });
}

std::string title_of(const StudyResults& results) {
  const std::string& processor = results.machine.processor;
  return "What the order of a mesh is worth" + (processor.empty() ? "" : " on " + processor);
}

std::string markdown_of(const Page& page) {
  std::string text = "# " + markdown_escaped(page.title) + "\n\n";
  auto rest = page.tables.begin();
  if (rest != page.tables.end() && rest->id == "summary") text += to_markdown({*rest++}) + "\n";
  for (const std::string& finding : page.findings) text += prose_as_markdown(finding) + "\n\n";
  return text + to_markdown({rest, page.tables.end()});
}

}  // namespace

void fill_from_results(Page& page, Notes& notes) {
  page.tables = tables_of(page.results);
  page.findings = findings_of(page.results);
  if (can_draw_figures()) {
    page.figures = figures_of(page.results);
  } else {
    notes.emplace_back("no figures: gnuplot is not installed (Debian: gnuplot-nox)");
  }
}

Page page_of(const StudyFolder& folder, const StudyResults& results, Notes& notes,
             const ReportProgress& progress, const PageDetail& detail) {
  Page page;
  page.title = title_of(results);
  page.results = results;
  Parts parts(results, progress);
  Meshes meshes;
  for (const MeshRecord& record : results.meshes) {
    parts.begin("the surface of " + record.name);
    const fs::path path = folder.mesh(record.name);
    if (!is_there(path)) {
      notes.push_back(fmt::format("the page does not show {}: {} is missing", record.name, path.string()));
      continue;
    }
    const Mesh& mesh = meshes.emplace(record.name, read_mesh_from(folder.file(path))).first->second;
    page.meshes.push_back(mesh_of(folder, results, record, mesh, notes, detail));
  }
  for (const ScenarioRecord& scenario : results.scenarios) {
    parts.begin("the motion of " + scenario.name);
    std::optional<PageMotion> motion = motion_of(folder, scenario, meshes, notes, detail);
    if (motion) page.motions.push_back(std::move(*motion));
  }
  parts.begin("tables and figures");
  fill_from_results(page, notes);
  return page;
}

WrittenReport write_report(const StudyFolder& folder, const ReportProgress& progress) {
  WrittenReport report;
  Page page = page_of(folder, read_results(folder.file(folder.results())), report.notes, progress);
  std::error_code code;
  if (!page.figures.empty()) fs::create_directories(folder.figure("any").parent_path(), code);
  if (code)
    throw InputError(folder.root().string(), "cannot be written: " + code.message(), "check the folder");
  std::vector<OutputFile> files;
  const auto add = [&](const fs::path& path, const std::string& content) {
    files.emplace_back(folder.file(path)).write(content);
    report.files.push_back(path);
  };
  add(folder.tables(".md"), markdown_of(page));
  add(folder.tables(".csv"), to_csv(page.tables));
  for (const Figure& figure : page.figures) add(folder.figure(figure.name), figure.svg);
  add(folder.page(), to_html(page));
  OutputFile::commit_all(files);
  report.results = std::move(page.results);
  report.findings = std::move(page.findings);
  return report;
}

}  // namespace meshorder
