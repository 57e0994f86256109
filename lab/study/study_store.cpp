// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/study_store.hpp"

#include "io/format.hpp"
#include "io/npy.hpp"
#include "io/stream/output_place.hpp"
#include "io/stream/output_set.hpp"
#include "lab/study/results_json.hpp"
#include "lab/study/statistics.hpp"
#include "lab/support/machine.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace meshorder {
namespace {
namespace fs = std::filesystem;

void make_folders(const StudyFolder& folder) {
  std::error_code code;
  fs::create_directories(folder.data(), code);
  if (code)
    throw InputError(folder.root().string(), "cannot be made: " + code.message(),
                     "name a folder for the results");
}

/// Returns the position of a scenario among the built-in ones; other scenarios come last.
std::ptrdiff_t place_of(const ScenarioRecord& record) {
  const auto known = built_in_scenarios();
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const BuiltInScenario& b) { return b.name == record.name; });
  return found - known.begin();
}

}  // namespace

StudyStore::StudyStore(const StudyPlan& plan, const StudyFolder& folder) : folder_(folder) {
  (void)output_place(folder.file(folder.mesh("any")));  // refuses a link before a folder is made through it
  make_folders(folder);
  lock_.emplace(folder.root());
  (void)OutputFile(folder.file(folder.mesh("any")));  // throws early if the folder cannot be written
  MachineRecord machine = describe_machine();
  std::error_code code;
  if (fs::exists(folder.results(), code)) {
    resume(plan, machine);
  } else {
    begin(plan, std::move(machine));
  }
}

void StudyStore::begin(const StudyPlan& plan, MachineRecord machine) {
  results_.began = timestamp_now();
  results_.size = plan.size;
  results_.runs = plan.runs;
  results_.threads = plan.threads;
  results_.reference = plan.reference;
  results_.orderings = plan.orderings;
  results_.machine = std::move(machine);
}

void StudyStore::resume(const StudyPlan& plan, const MachineRecord& machine) {
  results_ = read_results(folder_.file(folder_.results()));
  const auto same = [&](bool is_same, const std::string& what) {
    if (!is_same)
      throw InputError(folder_.results().string(), "is of a study with " + what,
                       "give a new folder, or the same options as before");
  };
  const MachineRecord& before = results_.machine;
  same(before.processor == machine.processor, "another processor: " + before.processor);
  same(before.program == machine.program && before.revision == machine.revision,
       program_in_words(before) + ", where this is " + program_in_words(machine));
  same(before.compiler == machine.compiler && before.flags == machine.flags, "another build of meshorder");
  same(results_.size == plan.size, "meshes of size " + results_.size);
  same(results_.threads == plan.threads, fmt::format("{} threads", results_.threads));
  same(results_.reference == plan.reference, "another reference: " + results_.reference);
  same(std::equal(results_.orderings.begin(), results_.orderings.end(), plan.orderings.begin(),
                  plan.orderings.end(), [](const auto& a, const auto& b) { return a.name == b.name; }),
       "other orderings");
  results_.runs = std::max(results_.runs, plan.runs);
  summarise(results_);
  write_results(results_, folder_.file(folder_.results()));
}

bool StudyStore::has_mesh(std::string_view name) const {
  return find_named(results_.meshes, name) != nullptr;
}

const ScenarioRecord* StudyStore::find(std::string_view scenario) const {
  return find_named(results_.scenarios, scenario);
}

int StudyStore::runs_done(std::string_view scenario) const {
  const ScenarioRecord* const record = find(scenario);
  return record == nullptr ? 0 : static_cast<int>(record->orders.front().runs.size());
}

ScenarioRecord StudyStore::new_record(const Scenario& scenario) const {
  ScenarioRecord record;
  record.name = scenario.name;
  record.title = scenario.title.empty() ? scenario.name : scenario.title;
  if (scenario.is_fluid()) {
    record.method = "particle-fem";
    record.material = "fluid";
    record.precision = to_string(MatrixPrecision::double_);
  } else if (scenario.is_implicit()) {
    record.method = "backward-euler";
    record.material = to_string(scenario.model);
    record.precision = to_string(scenario.implicit().precision);
  } else {
    record.method = "admm";
    record.material = to_string(scenario.projective().model);
    record.precision = to_string(scenario.projective().precision);
  }
  for (const OrderingSpec& ordering : results_.orderings)
    record.orders.emplace_back().ordering = ordering.name;
  return record;
}

void StudyStore::keep(const Mesh& mesh, OrderedMesh studied) {
  const std::string& name = studied.record.name;
  OutputSet files;
  for (std::size_t i = 0; i < studied.orders.size(); ++i) {
    const std::string& ordering = studied.record.orders[i].ordering;
    write_npy(studied.orders[i].vertices.permutation.old_to_new(),
              {folder_.file(folder_.vertex_order(name, ordering)), files});
    write_npy(studied.orders[i].cells.permutation.old_to_new(),
              {folder_.file(folder_.cell_order(name, ordering)), files});
  }
  Mesh bare;
  bare.points = mesh.points;
  bare.cells = mesh.cells;
  write_mesh_to(bare, {folder_.file(folder_.mesh(name)), files}, {});
  studied.record.file = fs::relative(folder_.mesh(name), folder_.root()).string();
  results_.meshes.push_back(std::move(studied.record));
  write_results(results_, {folder_.file(folder_.results()), files});
  files.commit();
}

void StudyStore::begin(ScenarioRecord record) {
  results_.scenarios.push_back(std::move(record));
  std::stable_sort(
      results_.scenarios.begin(), results_.scenarios.end(),
      [](const ScenarioRecord& a, const ScenarioRecord& b) { return place_of(a) < place_of(b); });
}

void StudyStore::keep(std::string_view scenario, const std::vector<RunRecord>& runs) {
  ScenarioRecord& record = *find_named(results_.scenarios, scenario);
  for (std::size_t i = 0; i < runs.size(); ++i) record.orders[i].runs.push_back(runs[i]);
  summarise(results_);
  write_results(results_, folder_.file(folder_.results()));
}

}  // namespace meshorder
