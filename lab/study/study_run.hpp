// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/folder.hpp"
#include "lab/study/study_plan.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace meshorder {

/// Callbacks of a study.
struct StudyObserver {
  /// Called when a stage begins or advances: share `from` of the study is done, the stage ends at `to`, 0
  /// … 1.
  std::function<void(const std::string& what, double from, double to)> stage = [](auto&&...) {};
  std::function<void(const std::string& message)> note = [](auto&&...) {};
  /// Called after each mesh and each turn. If it returns true, the study stops and loses its unfinished runs.
  std::function<bool()> stop = [] { return false; };
};

/// Runs a study, or the missing part of it, and updates results.json in the folder after each mesh and after
/// each run of a scenario in all orders. Returns true if it finished, false if it was stopped.
///
/// The orders of a mesh are computed once. In each run of a scenario, every order has a fresh process of
/// `program`, which is meshorder-lab, on the same processors and, where possible, without address space
/// randomisation. The processes take turns of about a second. Each run begins with another order, so that
/// changes of the machine's speed affect all orders alike. If memory cannot hold all orders, they run one
/// after another. The first run stores frames of the motion and compares them between the orders.
///
/// Throws Error, which says what differs, if the folder holds another study; throws Error or InvalidArgument
/// for errors in scenarios and meshes.
bool run_study(const StudyPlan& plan, const StudyFolder& folder, const std::filesystem::path& program,
               const StudyObserver& observer);

}  // namespace meshorder
