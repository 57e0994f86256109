// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/results_check.hpp"

#include <fmt/format.h>

#include <set>

namespace meshorder {
namespace {

/// Throws unless the number at `key` is 1 or more.
void expect_positive(std::int64_t number, const JsonValue& value, std::string_view key) {
  if (number < 1) throw value[key].error("is 0", "give 1 or more");
}

/// What the records of a list are called by; throws for a name that comes twice.
template <class Record>
std::set<std::string> names_of(const std::vector<Record>& records, std::string Record::*name,
                               const JsonValue& value, std::string_view list, std::string_view key) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!names.insert(records[i].*name).second)
      throw value[list].items()[i][key].error("'" + records[i].*name + "' comes twice", "keep one of them");
  }
  return names;
}

/// Throws unless the text at `value` is one of the names.
void expect_one_of(const std::set<std::string>& names, const JsonValue& value, std::string_view list) {
  if (!names.contains(value.text()))
    throw value.error("'" + value.text() + "' is none of the " + std::string(list),
                      "name one that is listed there");
}

void expect_size(const JsonValue& value, std::size_t wanted, std::string_view why) {
  const std::size_t size = value.items().size();
  if (size != wanted)
    throw value.error(fmt::format("has {} entries", size), fmt::format("give {}, {}", wanted, why));
}

void expect_misses(const std::vector<NamedCaches>& hierarchies, const JsonValue& order) {
  for (const Kernel kernel : kKernels) {
    const JsonValue misses = order["kernels"][name(kernel)]["misses"];
    const std::vector<JsonValue> of_hierarchy = misses.items();
    if (of_hierarchy.empty()) continue;
    expect_size(misses, hierarchies.size(), "one list for each of the hierarchies");
    for (std::size_t i = 0; i < of_hierarchy.size(); ++i)
      expect_size(of_hierarchy[i], hierarchies[i].caches.level_bytes.size(), "one for each cache");
  }
}

}  // namespace

void check_record(const Caches& caches, const JsonValue& value) {
  Offset before = 0;
  for (const Offset bytes : caches.level_bytes) {
    if (bytes <= before || bytes % kLineBytes != 0)
      throw value.error(fmt::format("{} is no size of a cache after {}", bytes, before),
                        fmt::format("sizes rise and are multiples of {}", kLineBytes));
    before = bytes;
  }
}

void check_record(const MeshRecord& mesh, const JsonValue& value) {
  expect_positive(mesh.span_bin, value, "span_bin");
  names_of(mesh.orders, &OrderOfMesh::ordering, value, "orders", "ordering");
  for (const JsonValue& order : value["orders"].items()) expect_misses(mesh.hierarchies, order);
}

void check_record(const ScenarioRecord& scenario, const JsonValue& value) {
  expect_positive(scenario.steps, value, "steps");
  expect_positive(scenario.turn, value, "turn");
  names_of(scenario.orders, &OrderOfScenario::ordering, value, "orders", "ordering");
  for (const JsonValue& order : value["orders"].items()) {
    for (const JsonValue& run : order["runs"].items())
      expect_size(run["step_seconds"], static_cast<std::size_t>(scenario.steps), "one for each step");
    const JsonValue differences = order["motion"]["by_frame"];
    if (!differences.items().empty())
      expect_size(differences, scenario.frame_steps.size(), "one for each of the frame_steps");
  }
}

void check_record(const StudyResults& results, const JsonValue& value) {
  expect_positive(results.runs, value, "runs");
  expect_positive(results.threads, value, "threads");
  const auto orderings = names_of(results.orderings, &StudyOrdering::name, value, "orderings", "name");
  const auto meshes = names_of(results.meshes, &MeshRecord::name, value, "meshes", "name");
  names_of(results.scenarios, &ScenarioRecord::name, value, "scenarios", "name");
  expect_one_of(orderings, value["reference"], "orderings");
  for (const std::string_view list : {"meshes", "scenarios"}) {
    for (const JsonValue& record : value[list].items()) {
      for (const JsonValue& order : record["orders"].items())
        expect_one_of(orderings, order["ordering"], "orderings");
    }
  }
  for (const JsonValue& scenario : value["scenarios"].items())
    expect_one_of(meshes, scenario["mesh"], "meshes");
}

}  // namespace meshorder
