// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

namespace meshorder {

/// Adjacent columns of L, and the rows below in which any of these columns has an entry.
struct Panel {
  static constexpr Index kWidest = 8;
  static constexpr Index kGroup = 4;  ///< rows in a group

  Index column;     ///< the first column
  Index width;      ///< number of columns
  Index row_count;  ///< number of rows below the columns
  Index parent;     ///< the panel that has the first row below as a column; −1 without rows
  Offset rows;      ///< where the panel's rows begin in PanelView::rows
  Offset values;    ///< where its values begin in PanelView::values
};

/// Panels of a factor L D Lᵀ. The values of a panel are, in this order:
/// - the entries of L in the triangle at the panel's columns, without the diagonal, row by row;
/// - 1/D of these columns;
/// - the entries of the rows below, in groups of kGroup rows and a last group of the remaining rows;
///   each group is stored column by column.
///
/// 16 more bytes must follow the last value. Vectors have kPaddedStride numbers for each column and row.
template <class Real>
struct PanelView {
  const Panel* panels;
  const Index* rows;
  const Real* values;
};

/// A choice of panels: those in `list`, or consecutive panels from `first` on if `list` is null.
struct PanelRange {
  const Index* list;
  Index first;
  Index count;

  [[nodiscard]] Index operator[](Index i) const noexcept { return list == nullptr ? first + i : list[i]; }
};

/// Computes x ← D⁻¹ L⁻¹ x at the columns of these panels; subtracts the columns' contributions from x at the
/// rows below. O(entries).
void sweep_forwards(const PanelView<double>& view, const PanelRange& range, double* x);
void sweep_forwards(const PanelView<float>& view, const PanelRange& range, float* x);

/// Computes x ← L⁻ᵀ x at the columns of these panels; the rows below must hold the solution. O(entries).
void sweep_backwards(const PanelView<double>& view, const PanelRange& range, double* x);
void sweep_backwards(const PanelView<float>& view, const PanelRange& range, float* x);

}  // namespace meshorder
