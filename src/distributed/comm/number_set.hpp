// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/layout.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace meshorder::distributed {

/// A set of global numbers that maps each to its position in ascending sequence.
class NumberSet {
 public:
  /// Takes numbers in any order; a number may occur several times. O(numbers) if their range is at most about
  /// 64 times their count, as in a mesh; else O(numbers · log numbers).
  explicit NumberSet(std::span<const GlobalIndex> numbers);

  /// Returns the numbers, ascending.
  [[nodiscard]] const std::vector<GlobalIndex>& numbers() const noexcept { return numbers_; }
  /// Returns the position in `numbers()` of a number of the set. O(1), or O(log numbers) if the numbers are
  /// far apart.
  [[nodiscard]] std::size_t position(GlobalIndex number) const;

 private:
  /// Word k of the set: a bit for each of the numbers first_ + 64 k … first_ + 64 k + 63.
  struct Word {
    std::uint64_t bits = 0;
    std::size_t before = 0;  ///< count of the numbers in earlier words
  };

  std::vector<GlobalIndex> numbers_;
  GlobalIndex first_ = 0;
  std::vector<Word> words_;  ///< empty if the numbers are far apart
};

}  // namespace meshorder::distributed
