// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/layout.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace meshorder::distributed {

/// Numbers among those of all ranks that a rank has to do with, each once, and their places.
class NumberSet {
 public:
  /// Takes numbers in any order, some perhaps several times. O(numbers) where they lie as close together as
  /// those of a mesh do, else O(numbers · log numbers).
  explicit NumberSet(std::span<const GlobalIndex> numbers);

  /// Returns the numbers, ascending.
  [[nodiscard]] const std::vector<GlobalIndex>& numbers() const noexcept { return numbers_; }
  /// Returns the place of one of the numbers among them. O(1) or O(log numbers), likewise.
  [[nodiscard]] std::size_t position(GlobalIndex number) const;

 private:
  /// Numbers first_ + 64 k … first_ + 64 k + 63, a bit for each.
  struct Word {
    std::uint64_t bits = 0;
    std::size_t before = 0;  ///< numbers of the words before
  };

  std::vector<GlobalIndex> numbers_;
  GlobalIndex first_ = 0;
  std::vector<Word> words_;  ///< none where the numbers are far apart
};

}  // namespace meshorder::distributed
