// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace meshorder::distributed {

/// Number of a vertex, cell or entry among those of all ranks. Positions within a rank have type `Index`.
using GlobalIndex = std::int64_t;

/// A division of consecutive numbers into ranges, one per rank, ascending: rank r owns begin(r) … end(r) − 1.
class Layout {
 public:
  /// Makes a layout without ranks and numbers.
  Layout() = default;

  /// Takes the first number of each rank, ascending, followed by the end of the last rank's numbers.
  explicit Layout(std::vector<GlobalIndex> starts) : starts_(std::move(starts)) {}

  /// Divides 0 … count − 1 into `ranks` > 0 ranges whose sizes differ by at most one. O(ranks).
  static Layout even(GlobalIndex count, int ranks) {
    std::vector<GlobalIndex> starts(static_cast<std::size_t>(ranks) + 1, 0);
    const GlobalIndex each = count / ranks;
    const GlobalIndex more = count % ranks;  // the first `more` ranks get one more
    for (GlobalIndex r = 0; r < ranks; ++r)
      starts[static_cast<std::size_t>(r) + 1] = (r + 1) * each + std::min(r + 1, more);
    return Layout(std::move(starts));
  }

  /// Divides the numbers from 0 on: rank r gets sizes[r] of them. O(ranks).
  static Layout of_sizes(const std::vector<GlobalIndex>& sizes) {
    std::vector<GlobalIndex> starts(sizes.size() + 1, 0);
    std::partial_sum(sizes.begin(), sizes.end(), starts.begin() + 1);
    return Layout(std::move(starts));
  }

  [[nodiscard]] int ranks() const noexcept { return static_cast<int>(starts_.size()) - 1; }
  /// Returns the count of all numbers.
  [[nodiscard]] GlobalIndex size() const { return starts_.back() - starts_.front(); }
  /// Returns the count of a rank's numbers.
  [[nodiscard]] GlobalIndex size(int rank) const { return end(rank) - begin(rank); }
  [[nodiscard]] GlobalIndex begin(int rank) const { return starts_[static_cast<std::size_t>(rank)]; }
  [[nodiscard]] GlobalIndex end(int rank) const { return starts_[static_cast<std::size_t>(rank) + 1]; }
  /// Returns the first number of each rank, followed by the end of the last rank's numbers.
  [[nodiscard]] const std::vector<GlobalIndex>& starts() const noexcept { return starts_; }
  /// Returns the rank that owns a number of the layout. O(log ranks).
  [[nodiscard]] int owner(GlobalIndex number) const {
    return static_cast<int>(std::upper_bound(starts_.begin(), starts_.end(), number) - starts_.begin()) - 1;
  }

 private:
  std::vector<GlobalIndex> starts_{0};
};

}  // namespace meshorder::distributed
