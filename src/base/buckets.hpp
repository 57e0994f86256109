// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace meshorder {

/// Entries in buckets of neighbouring keys, those of a bucket as they came: the first step of a sort of more
/// entries than caches hold, whose second one sorts every bucket by itself. Entries come in parts, each of
/// which a thread puts into buckets of its own, so that all writes stay near each other in whatever order the
/// keys come. The same for any number of threads. O(entries + parts · buckets) time and memory.
template <class Entry>
class Buckets {
 public:
  /// @param keys     how many there are: 0 … keys − 1
  /// @param part_of  `part_of(part)` returns what calls its argument for each entry of a part, best some
  ///                 10⁵ of them, and does so twice. Called on all threads.
  /// @param key      `key(entry)`
  template <class PartOf, class Key>
  Buckets(Index parts, Index keys, const PartOf& part_of, const Key& key) : keys_(keys), parts_(parts) {
    while (chunk_count(keys, width()) > kMostBuckets) ++log2_width_;
    parallel_loop(parts, [&](Index k) {
      const auto for_each_entry = part_of(k);
      Part& part = parts_[k];
      std::vector<Offset> next(std::size_t(size()) + 1, 0);
      for_each_entry([&](const Entry& entry) { ++next[bucket_of(key(entry)) + 1]; });
      std::partial_sum(next.begin(), next.end(), next.begin());
      part.starts = next;
      part.entries.resize(std::size_t(next.back()));
      for_each_entry([&, entries = part.entries.data(), next = next.data()](const Entry& entry) {
        entries[next[bucket_of(key(entry))]++] = entry;
      });
    });
    starts_.assign(std::size_t(size()) + 1, 0);
    for (const Part& part : parts_) {
      for (Index bucket = 0; bucket < size(); ++bucket) starts_[bucket + 1] += std::ssize(part[bucket]);
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  }

  /// How many buckets there are.
  [[nodiscard]] Index size() const { return chunk_count(keys_, width()); }

  /// How many entries come before the bucket.
  [[nodiscard]] Offset start(Index bucket) const { return starts_[bucket]; }

  [[nodiscard]] Index first_key(Index bucket) const { return bucket << log2_width_; }

  /// Returns how many entries come before those of each key of the bucket, and of its end.
  template <class Key>
  [[nodiscard]] std::vector<Offset> key_starts(Index bucket, const Key& key) const {
    std::vector<Offset> starts(std::size_t(std::min(width(), keys_ - first_key(bucket))) + 1, 0);
    for_each(bucket, [&](const Entry& entry) { ++starts[key(entry) - first_key(bucket) + 1]; });
    starts[0] = start(bucket);
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    return starts;
  }

  /// Calls `visit(entry)` for the entries of the bucket, in the order in which they came.
  template <class Visit>
  void for_each(Index bucket, const Visit& visit) const {
    for (const Part& part : parts_) std::ranges::for_each(part[bucket], visit);
  }

 private:
  static constexpr Index kMostBuckets = 2048;

  struct Part {
    std::vector<Entry> entries;
    std::vector<Offset> starts;  ///< of each bucket, and the end

    std::span<const Entry> operator[](Index bucket) const {
      return {entries.data() + starts[bucket], entries.data() + starts[bucket + 1]};
    }
  };

  [[nodiscard]] Index width() const { return Index{1} << log2_width_; }
  [[nodiscard]] Index bucket_of(Index key) const { return key >> log2_width_; }

  Index keys_;
  int log2_width_ = 10;  ///< of the keys of a bucket
  std::vector<Part> parts_;
  std::vector<Offset> starts_;  ///< of each bucket, and the end
};

}  // namespace meshorder
