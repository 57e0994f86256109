// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace meshorder {

/// A small dense matrix, row after row.
struct Rows {
  std::size_t columns = 0;
  std::vector<double> values = {};

  [[nodiscard]] std::size_t size() const noexcept { return columns == 0 ? 0 : values.size() / columns; }
  [[nodiscard]] std::span<const double> operator[](std::size_t row) const {
    return std::span(values).subspan(row * columns, columns);
  }
  /// Appends a row of `columns` numbers.
  void push_back(std::span<const double> row) { values.insert(values.end(), row.begin(), row.end()); }
};

/// Returns x ≥ 0 that minimises ‖a x − b‖ (Lawson and Hanson 1974, Solving least squares problems, chapter
/// 23). Columns may differ in scale by orders of magnitude. The unknowns of zero columns are 0. If columns
/// depend on each other, some of their unknowns are 0. O(rows · columns² + steps · columns³) time. Throws
/// InvalidArgument unless `b` has an entry for each row.
std::vector<double> non_negative_least_squares(const Rows& a, std::span<const double> b);

/// Returns the ratio of the largest and the smallest singular value of `a`, with its columns scaled to length
/// 1: the factor by which a relative error of the right side can grow in the solution. Zero columns are left
/// out. Infinite if the other columns depend on each other, 1 if there are no other columns.
double condition_number(const Rows& a);

}  // namespace meshorder
