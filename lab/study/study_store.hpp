// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/folder.hpp"
#include "lab/study/folder_lock.hpp"
#include "lab/study/mesh_study.hpp"
#include "lab/study/study_plan.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The results of a study in its folder. `keep` updates results.json, completely or not at all.
class StudyStore {
 public:
  /// Makes the folder and begins a study, or resumes the folder's study. Throws Error if the folder cannot be
  /// made or written, if another process works on it, or if its study has another processor, build, mesh
  /// size, number of threads, reference or orderings.
  StudyStore(const StudyPlan& plan, const StudyFolder& folder);

  [[nodiscard]] const StudyFolder& folder() const noexcept { return folder_; }
  [[nodiscard]] bool has_mesh(std::string_view name) const;
  /// Returns the record of a scenario; null if none of its runs is finished.
  [[nodiscard]] const ScenarioRecord* find(std::string_view scenario) const;
  [[nodiscard]] int runs_done(std::string_view scenario) const;
  /// Returns a record without runs, with the study's orderings.
  [[nodiscard]] ScenarioRecord new_record(const Scenario& scenario) const;

  /// Stores a mesh with its orders and sets `record.file`.
  void keep(const Mesh& mesh, OrderedMesh studied);
  /// Adds the record of a scenario, before its first run is stored.
  void begin(ScenarioRecord record);
  /// Stores a run of a scenario: one record for each order.
  void keep(std::string_view scenario, const std::vector<RunRecord>& runs);

 private:
  void begin(const StudyPlan& plan, MachineRecord machine);
  void resume(const StudyPlan& plan, const MachineRecord& machine);

  const StudyFolder& folder_;
  std::optional<FolderLock> lock_;
  StudyResults results_;
};

}  // namespace meshorder
