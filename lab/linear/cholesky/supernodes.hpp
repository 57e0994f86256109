// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/cholesky/ldl.hpp"

#include <vector>

namespace meshorder {

/// What a triangular solve takes, in units of one entry of L, where the entries stand in panels: some columns
/// side by side with the rows that any of them has.
struct PanelCosts {
  Index widest = 8;     ///< columns of a panel at most
  double panel = 30.0;  ///< to begin with one
  double row = 2.0;     ///< to read a row's number and to load and store it
};

/// The columns of L in groups whose patterns are so nearly alike that they are stored as one (relaxed
/// supernodes, Ashcraft and Grimes 1989), as the forest that the elimination tree makes of them.
struct Supernodes {
  std::vector<Index> of_column;  ///< the supernode of each column of L
  std::vector<Index> parent;     ///< greater than the supernode, or −1
  std::vector<Index> top;        ///< its last column of L, whose pattern is that of the rows below
  std::vector<double> cost;      ///< of its panels, by PanelCosts

  [[nodiscard]] Index count() const noexcept { return static_cast<Index>(parent.size()); }
};

/// Panels of the same width, but for one column, that a supernode of so many columns is cut into.
constexpr Index panel_count(Index columns, Index widest) { return (columns + widest - 1) / widest; }

/// Joins each column with those of its children in the elimination tree where that makes the solve cheaper.
/// O(columns log columns).
Supernodes find_supernodes(const Ldl& ldl, const PanelCosts& costs = {});

/// A tree of tasks over a forest of supernodes: a task can start once those below it are done, and those are
/// independent of each other. Task 0 is the root; a task's number is greater than its parent's.
struct SolveTasks {
  std::vector<Index> parent;                   ///< −1 for task 0
  std::vector<std::vector<Index>> children;    ///< rising
  std::vector<std::vector<Index>> supernodes;  ///< of each task, rising: those below others come first
  std::vector<double> cost;                    ///< of a task and all below it

  [[nodiscard]] Index count() const noexcept { return static_cast<Index>(parent.size()); }
};

/// Cuts the forest wherever two branches or more are worth a task: each costs at least `min_cost`; small
/// branches are bundled. Does not depend on the number of threads. O(supernodes).
SolveTasks make_solve_tasks(const Supernodes& supernodes, double min_cost);

}  // namespace meshorder
