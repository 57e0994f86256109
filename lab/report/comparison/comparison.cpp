// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/comparison/comparison.hpp"

#include "io/stream/output_file.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/page/page.hpp"
#include "lab/report/tables/tables.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

/// Checks that two studies agree, description by description.
class Comparison {
 public:
  Comparison(const ComparedStudy& a, const ComparedStudy& b) : a_(a), b_(b) {}

  /// Throws unless `a` equals `b`.
  void expect_same(std::string_view what, const std::string& a, const std::string& b) const {
    if (a != b) refuse(fmt::format("{} {}, where {} has {}", what, b, a_.file, a));
  }

  /// Throws unless both lists have records of the same names.
  template <class Record>
  void expect_same_names(std::string_view what, const std::vector<Record>& a,
                         const std::vector<Record>& b) const {
    const std::string missing = names_without(a, b);
    if (!missing.empty()) refuse(fmt::format("no {} {}, which {} has", what, missing, a_.file));
    const std::string more = names_without(b, a);
    if (!more.empty()) refuse(fmt::format("the {} {}, which {} lacks", what, more, a_.file));
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(b_.file, "has " + what, "compare studies of the same meshes, scenarios and precisions");
  }

 private:
  /// Returns the names in `list` that `other` lacks, in words.
  template <class Record>
  static std::string names_without(const std::vector<Record>& list, const std::vector<Record>& other) {
    std::vector<std::string> names;
    for (const Record& record : list) {
      if (find_named(other, record.name) == nullptr) names.push_back(record.name);
    }
    return in_words(names);
  }

  const ComparedStudy& a_;
  const ComparedStudy& b_;
};

std::string counts_of(const MeshRecord& mesh) {
  return fmt::format("{} vertices and {} tetrahedra", count_cell(mesh.vertices).text,
                     count_cell(mesh.tetrahedra).text);
}

void check_scenario(const Comparison& compare, const ScenarioRecord& a, const ScenarioRecord& b) {
  const auto of = [&](const char* what) { return fmt::format("{} {}", a.name, what); };
  compare.expect_same(of("on the mesh"), a.mesh, b.mesh);
  if (!a.precision.empty() && !b.precision.empty())
    compare.expect_same(of("in the precision"), a.precision, b.precision);
  compare.expect_same(of("by the method"), a.method, b.method);
  compare.expect_same(of("of the material"), a.material, b.material);
  if (a.fingerprint == b.fingerprint) return;
  // the first half is the checksum of the mesh, the second half the checksum of the parameters
  constexpr std::size_t kHalf = 16;
  const bool mesh_differs = a.fingerprint.substr(0, kHalf) != b.fingerprint.substr(0, kHalf);
  compare.refuse(
      mesh_differs
          ? fmt::format("{} on another mesh of the name {} (other places or tetrahedra)", a.name, a.mesh)
          : fmt::format("another {} (other parameters: forces, material, precision, tolerances …)", a.name));
}

std::string machine_of(const StudyResults& results) {
  return results.machine.processor.empty() ? "an unknown machine" : results.machine.processor;
}

}  // namespace

void check_comparable(const ComparedStudy& a, const ComparedStudy& b) {
  const Comparison compare(a, b);
  for (const ComparedStudy* const study : {&a, &b}) {
    if (study->results.scenarios.empty())
      throw InputError(study->file, "has no scenario that was run",
                       "compare studies that `meshorder reproduce` made");
  }
  compare.expect_same("meshes of size", a.results.size, b.results.size);
  compare.expect_same_names("mesh", a.results.meshes, b.results.meshes);
  for (const MeshRecord& mesh : a.results.meshes) {
    const MeshRecord& other = *find_named(b.results.meshes, mesh.name);
    compare.expect_same("a mesh " + mesh.name + " of", counts_of(mesh), counts_of(other));
  }
  compare.expect_same_names("scenario", a.results.scenarios, b.results.scenarios);
  for (const ScenarioRecord& scenario : a.results.scenarios)
    check_scenario(compare, scenario, *find_named(b.results.scenarios, scenario.name));
  compare.expect_same("the reference", a.results.reference, b.results.reference);
}

std::optional<SavingDifference> difference_of(const Speedup& a, const Speedup& b) {
  if (a.low >= a.high || b.low >= b.high) return std::nullopt;
  SavingDifference difference;
  difference.points = b.percent - a.percent;
  difference.low = difference.points - std::hypot(b.percent - b.low, a.high - a.percent);
  difference.high = difference.points + std::hypot(b.high - b.percent, a.percent - a.low);
  difference.beyond_noise = difference.low > 0 || difference.high < 0;
  return difference;
}

std::vector<ComparedOrder> compared_orders(const StudyResults& a, const StudyResults& b) {
  std::vector<ComparedOrder> orders;
  for_each_order(a, true, [&](const ScenarioRecord& scenario, const ScenarioOrderRecord& order) {
    const ScenarioRecord* const other = find_named(b.scenarios, scenario.name);
    if (other == nullptr || find_order(*other, b.reference) == nullptr) return;
    const ScenarioOrderRecord* const there = find_order(*other, order.ordering);
    if (there == nullptr) return;
    orders.push_back({scenario.name, order.ordering, order.speedup, there->speedup,
                      difference_of(order.speedup, there->speedup)});
  });
  return orders;
}

std::vector<std::string> comparison_findings(const ComparedStudy& a, const ComparedStudy& b) {
  std::size_t known = 0;
  std::size_t apart = 0;
  std::vector<std::string> turned;
  for (const ComparedOrder& order : compared_orders(a.results, b.results)) {
    if (order.a.beyond_noise && order.b.beyond_noise && (order.a.percent > 0) != (order.b.percent > 0))
      turned.push_back(fmt::format("{} in {}", title_of(a.results, order.ordering), order.scenario));
    if (!order.difference) continue;
    ++known;
    apart += order.difference->beyond_noise ? 1 : 0;
  }
  std::vector<std::string> findings;
  if (known > 0) {
    findings.push_back(fmt::format(
        "Of {} savings that both studies measured, {} differ beyond the noise; by chance alone about "
        "one of twenty would.",
        known, apart));
  }
  if (!turned.empty())
    findings.push_back(
        fmt::format("These save time for certain in one study and cost time for certain in the other: {}.",
                    in_words(turned)));
  std::vector<std::string> shorter;
  for (const ScenarioRecord& scenario : a.results.scenarios) {
    const ScenarioRecord* const other = find_named(b.results.scenarios, scenario.name);
    if (other != nullptr && other->steps != scenario.steps)
      shorter.push_back(
          fmt::format("{} ({} steps in A, {} in B)", scenario.name, scenario.steps, other->steps));
  }
  if (!shorter.empty()) {
    findings.push_back(
        fmt::format("Different numbers of steps: {}. Later steps may gain more or less than the first ones.",
                    in_words(shorter)));
  }
  const auto dashed = [](const StudyResults& results) {
    return std::any_of(results.scenarios.begin(), results.scenarios.end(),
                       [](const ScenarioRecord& scenario) { return scenario.precision.empty(); });
  };
  if (dashed(a.results) != dashed(b.results)) {
    findings.emplace_back(
        "One of the studies does not record the precision of its scenarios; the checksums of their "
        "parameters, which "
        "are the same, include it.");
  }
  return findings;
}

WrittenComparison write_comparison(const ComparedStudy& a, const ComparedStudy& b, const FilePath& page) {
  check_comparable(a, b);
  Page content;
  content.title =
      fmt::format("What orders save: {} (A) and {} (B)", machine_of(a.results), machine_of(b.results));
  content.tables = comparison_tables(a, b);
  content.findings = comparison_findings(a, b);
  std::string markdown = "# " + markdown_escaped(content.title) + "\n\n";
  markdown += to_markdown({content.tables.front()});
  for (const std::string& finding : content.findings) markdown += "\n" + prose_as_markdown(finding) + "\n";
  markdown += "\n" + to_markdown({content.tables.begin() + 1, content.tables.end()});

  WrittenComparison written;
  std::vector<OutputFile> files;
  const auto add = [&](const FilePath& path, const std::string& text) {
    files.emplace_back(path).write(text);
    written.files.push_back(path.path());
  };
  add(page.companion(".md"), markdown);
  add(page.companion(".csv"), to_csv(content.tables));
  add(page, fill_page(viewer_sources().comparison, content));
  OutputFile::commit_all(files);
  written.tables = std::move(content.tables);
  written.findings = std::move(content.findings);
  return written;
}

}  // namespace meshorder
