// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/cholesky/ldl.hpp"

#include <vector>

namespace meshorder {

/// Costs of a triangular solve in units of one entry of L. The entries are stored in panels: neighbouring
/// columns with the union of their rows.
struct PanelCosts {
  Index widest = 8;     ///< largest number of columns of a panel
  double panel = 30.0;  ///< to start a panel
  double row = 2.0;     ///< to read a row's index and to load and store the row
};

/// Groups of columns of L with similar patterns, each stored with one pattern (relaxed supernodes, Ashcraft
/// and Grimes 1989), and the forest that they inherit from the elimination tree.
struct Supernodes {
  std::vector<Index> of_column;  ///< the supernode of each column of L
  std::vector<Index> parent;     ///< the parent's number, which is greater; −1 for a root
  std::vector<Index> top;        ///< its last column of L, which has entries in all rows below the supernode
  std::vector<double> cost;      ///< of its panels, by PanelCosts

  [[nodiscard]] Index count() const noexcept { return static_cast<Index>(parent.size()); }
};

/// Returns the number of panels of a supernode with `columns` columns; their widths differ by at most one
/// column.
constexpr Index panel_count(Index columns, Index widest) { return (columns + widest - 1) / widest; }

/// Returns the supernodes: joins a column and each of its children in the elimination tree unless that makes
/// the solve costlier. O(columns log columns).
Supernodes find_supernodes(const Ldl& ldl, const PanelCosts& costs = {});

/// A tree of tasks over a forest of supernodes. A task can start when its children are done; its children are
/// independent of each other. Task 0 is the root; a task's number is greater than its parent's.
struct SolveTasks {
  std::vector<Index> parent;                 ///< −1 for task 0
  std::vector<std::vector<Index>> children;  ///< ascending
  std::vector<std::vector<Index>>
      supernodes;            ///< of each task, ascending: children come before their parents
  std::vector<double> cost;  ///< of a task and all below it

  [[nodiscard]] Index count() const noexcept { return static_cast<Index>(parent.size()); }
};

/// Returns the tasks: cuts the forest wherever two or more branches each cost at least `min_cost`; smaller
/// branches are bundled. The tasks do not depend on the number of threads. O(supernodes).
SolveTasks make_solve_tasks(const Supernodes& supernodes, double min_cost);

}  // namespace meshorder
