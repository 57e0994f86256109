// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "lab/linear/cholesky/ldl.hpp"
#include "lab/linear/cholesky/panel_sweeps.hpp"

#include <cstddef>
#include <vector>

namespace meshorder {

/// A part of a solve, independent of tasks that are neither above nor below it in the tree of tasks. In its
/// own slots, a task sums its contributions to the rows of tasks above; the task above then adds the slots.
/// So tasks can run at the same time, and sums have the same order on any number of threads.
struct PanelTask {
  Index first_column, end_column;
  Index first_panel, end_panel;
  Index first_slot, end_slot;   ///< places in the vector of the solve, after all columns
  std::vector<Index> children;  ///< with smaller numbers
  double cost;                  ///< of the task and all tasks below it, see PanelCosts
};

/// L D Lᵀ in panels (see PanelView), in the order of a forward sweep. The vector of a solve has a place of
/// kPaddedStride numbers for each column and for each slot of a task.
template <class Real>
struct PanelFactor {
  std::vector<Index> vertex_of_column;  ///< the row of the matrix for each column
  std::vector<Index> column_of_vertex;
  std::vector<Index> panel_of_column;
  std::vector<Panel> panels;
  std::vector<Index> rows;  ///< of all panels: the place of a column or slot
  AlignedVector<Real> values;
  std::vector<PanelTask> tasks;    ///< children before their parents; the last is the root
  std::vector<Index> above_slots;  ///< for each slot of all tasks: the place that it is added to

  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(vertex_of_column.size()); }
  /// Returns the number of places of a vector.
  [[nodiscard]] Index places() const noexcept { return size() + static_cast<Index>(above_slots.size()); }
  [[nodiscard]] PanelView<Real> view() const noexcept { return {panels.data(), rows.data(), values.data()}; }
  [[nodiscard]] std::size_t bytes() const;
};

/// Arranges a factor in panels and tasks. O(entries).
template <class Real>
PanelFactor<Real> make_panel_factor(const Ldl& ldl);

}  // namespace meshorder
