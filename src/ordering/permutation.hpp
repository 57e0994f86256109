// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {

/// A bijection of 0 … n−1 that holds both directions by name, so that nobody confuses one with the other.
///
/// `old_to_new()[i]` is the new place of what stood at place i; `new_to_old()[k]` is where the thing that
/// now stands at place k came from. Every constructor checks that its argument is a bijection.
class Permutation {
 public:
  /// The empty permutation, n = 0.
  Permutation() = default;

  static Permutation identity(Index n);

  /// `map[i]` is the new place of old i. Throws InvalidArgument unless it is a bijection. O(n).
  static Permutation from_old_to_new(std::vector<Index> map);

  /// `map[k]` is the old place of new k, that is, the old things in their new order. O(n).
  static Permutation from_new_to_old(std::vector<Index> map);

  [[nodiscard]] Index size() const noexcept { return index_size(old_to_new_); }
  [[nodiscard]] const std::vector<Index>& old_to_new() const noexcept { return old_to_new_; }
  [[nodiscard]] const std::vector<Index>& new_to_old() const noexcept { return new_to_old_; }
  [[nodiscard]] bool is_identity() const noexcept;

  /// The permutation that puts everything back.
  [[nodiscard]] Permutation inverse() const;

  /// This permutation, and after it `next`: the result's old_to_new is next.old_to_new[old_to_new[i]].
  [[nodiscard]] Permutation then(const Permutation& next) const;

  bool operator==(const Permutation&) const = default;

  /// `values`, `width` entries for each place, moved to their new places. Throws InvalidArgument when the
  /// sizes differ. O(n · width) time and memory.
  template <class T>
  [[nodiscard]] std::vector<T> moved(const std::vector<T>& values, std::size_t width = 1) const {
    check_size(values.size(), width);
    std::vector<T> result(values.size());
    for_each_chunk(size(), kPlacesAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
      const auto row = static_cast<Offset>(width);
      for (Index place = begin; place < end; ++place) {
        std::copy_n(values.begin() + new_to_old_[place] * row, row, result.begin() + place * row);
      }
    });
    return result;
  }

 private:
  Permutation(std::vector<Index> old_to_new, std::vector<Index> new_to_old)
      : old_to_new_(std::move(old_to_new)), new_to_old_(std::move(new_to_old)) {}
  void check_size(std::size_t values, std::size_t width) const;

  static constexpr Index kPlacesAtOnce = 65536;  // that a thread moves together
  std::vector<Index> old_to_new_;
  std::vector<Index> new_to_old_;
};

}  // namespace meshorder
