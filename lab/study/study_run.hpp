// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/folder.hpp"
#include "lab/study/study_plan.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace meshorder {

/// Who watches a study.
struct StudyObserver {
  /// Is told what is done, and the shares of the whole between which that lies.
  std::function<void(const std::string& what, double from, double to)> stage = [](auto&&...) {};
  std::function<void(const std::string& sentence)> note = [](auto&&...) {};
  /// Asked after each turn; the study stops when it says yes, and loses the runs that are not finished.
  std::function<bool()> stop = [] { return false; };
};

/// Runs a study, or what is missing of it, and keeps what it finds in the folder's results.json, after each
/// mesh and after each run of a scenario in all orders. Returns whether it was finished rather than stopped.
///
/// For each mesh the orders are computed once. For each scenario and run every order gets a fresh process of
/// `program`, which is meshorder, bound to the same processors, its memory at the same addresses; they step
/// by turns of about a second, each turn begun by the next order, so that a machine that changes its pace
/// changes it for all of them. Where memory does not hold all orders they run one after another. In the first
/// run frames of the motion are kept, and compared between the orders.
///
/// Throws Error when the folder holds another study, naming what differs, and for what scenarios and meshes
/// have wrong.
bool run_study(const StudyPlan& plan, const StudyFolder& folder, const std::filesystem::path& program,
               const StudyObserver& observer);

}  // namespace meshorder
