// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/folder.hpp"
#include "lab/study/mesh_study.hpp"
#include "lab/study/study_plan.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// What a study has found, and the folder that keeps it: results.json is whole after every call.
class StudyStore {
 public:
  /// Makes the folder and begins a study in it, or goes on with the one that is there. Throws Error when the
  /// folder cannot be made, and when the study in it is another one: on another machine, by another build, of
  /// other orders, threads or sizes.
  StudyStore(const StudyPlan& plan, const StudyFolder& folder);

  [[nodiscard]] const StudyFolder& folder() const noexcept { return folder_; }
  [[nodiscard]] bool has_mesh(std::string_view name) const;
  /// Null where no run of the scenario is finished.
  [[nodiscard]] const ScenarioRecord* find(std::string_view scenario) const;
  [[nodiscard]] int runs_done(std::string_view scenario) const;
  /// The record of a scenario without runs, with the study's orderings.
  [[nodiscard]] ScenarioRecord new_record(const Scenario& scenario) const;

  /// Keeps a mesh with its orders. `record.file` is filled in.
  void keep(const Mesh& mesh, OrderedMesh studied);
  /// Keeps a scenario of which no run is finished yet.
  void begin(ScenarioRecord record);
  /// Keeps one more run of a scenario that has begun, in all orders.
  void keep(std::string_view scenario, const std::vector<RunRecord>& runs);

 private:
  void begin(const StudyPlan& plan, MachineRecord machine);
  void resume(const StudyPlan& plan, const MachineRecord& machine);
  void save() const;

  const StudyFolder& folder_;
  StudyResults results_;
};

}  // namespace meshorder
