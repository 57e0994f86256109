// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace meshorder {

/// The ids of a file's vertices or cells, in file order, and a map from each id to its position, counted from
/// 0. Consecutive ids take no memory. Otherwise small ids are in a table, all others in a hash map.
class IdMap {
 public:
  /// Appends the id of the next position. Returns false and leaves the map unchanged if `id` is already
  /// present. O(1).
  bool add(std::int64_t id) {
    if (ids_.empty() &&
        (size_ == 0 || (id > first_ && above_first(id) == static_cast<std::uint64_t>(size_)))) {
      if (size_ == 0) first_ = id;
      ++size_;
      return true;
    }
    if (find(id) >= 0) return false;
    if (ids_.empty()) {
      // the ids are no longer consecutive: from now on every id is kept
      for (Index i = 0; i < size_; ++i) keep(first_ + i, i);
    }
    keep(id, size_);
    ++size_;
    return true;
  }

  /// Appends the ids first, first + 1, … to a map that is empty. O(1).
  void add_run(std::int64_t first, Index count) {
    first_ = first;
    size_ = count;
  }

  /// Returns the position of `id`, −1 if it is not present. O(1).
  [[nodiscard]] Index find(std::int64_t id) const {
    if (ids_.empty()) {
      const bool within = id >= first_ && above_first(id) < static_cast<std::uint64_t>(size_);
      return within ? static_cast<Index>(id - first_) : -1;
    }
    if (id >= 0 && id < index_size(table_) && table_[id] >= 0) return table_[id];
    const auto found = sparse_.find(id);
    return found == sparse_.end() ? -1 : found->second;
  }

  [[nodiscard]] Index size() const noexcept { return size_; }

  /// Returns the id at that position. O(1).
  [[nodiscard]] std::int64_t id(Index position) const {
    return ids_.empty() ? first_ + position : ids_[position];
  }

  /// Returns whether the ids are base, base + 1, … (or there are none).
  [[nodiscard]] bool runs_from(std::int64_t base) const noexcept {
    return size_ == 0 || (ids_.empty() && first_ == base);
  }

  /// Returns all ids; empty if they are base, base + 1, …
  [[nodiscard]] std::vector<std::int64_t> ids_unless_from(std::int64_t base) const {
    std::vector<std::int64_t> result;
    if (runs_from(base)) return result;
    result.reserve(size_);
    for (Index i = 0; i < size_; ++i) result.push_back(id(i));
    return result;
  }

 private:
  /// id − first_ for id ≥ first_; unsigned because it may need 64 bits.
  [[nodiscard]] std::uint64_t above_first(std::int64_t id) const {
    return static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first_);
  }

  void keep(std::int64_t id, Index position) {
    ids_.push_back(id);
    // the table has at most a few entries per id; ids outside its range go into the hash map
    const std::int64_t dense = 4 * std::int64_t{size_} + 1024;
    if (id < 0 || id >= dense || id >= kMaxIndex / 2) {
      sparse_.emplace(id, position);
      return;
    }
    if (id >= index_size(table_)) table_.resize(id + 1 + id / 2, -1);
    table_[id] = position;
  }

  Index size_ = 0;
  std::int64_t first_ = 0;
  std::vector<std::int64_t> ids_;  // empty as long as the ids are consecutive
  std::vector<Index> table_;       // id → position or −1
  std::unordered_map<std::int64_t, Index> sparse_;
};

}  // namespace meshorder
