// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace meshorder {

/// The form in which a bucket stores an entry; by default unchanged. A specialisation can take less memory:
/// it stores the row relative to the first row of the part, and the key relative to the first key of the
/// bucket. A bucket has at most 65,536 keys.
template <class Entry>
struct StoredEntry {
  Entry entry;

  static StoredEntry of(const Entry& entry, Index /*first_row*/, Index /*first_key*/) { return {entry}; }
  [[nodiscard]] const Entry& whole(Index /*first_row*/, Index /*first_key*/) const { return entry; }
};

/// Entries in buckets of adjacent keys, in their given order within a bucket. Filling buckets is the first
/// step of sorting more entries than the caches hold; the second step sorts each bucket. Each thread fills
/// its own buckets with a part of the entries: its writes then stay in its caches, whatever the order of the
/// keys. The result is the same for any number of threads. O(entries + parts · buckets) time and memory.
template <class Entry>
class Buckets {
 public:
  /// @param rows         number of rows that the entries come from
  /// @param rows_of_part  rows that a thread takes at a time; they should have about 10⁵ entries
  /// @param keys         number of keys, which are 0 … keys − 1
  /// @param entries_of   `entries_of(part, begin, end)` returns a function, called twice, that calls its
  ///                     argument for each entry of the part's rows. Parts run on all threads
  /// @param key          `key(entry)` returns the key of an entry
  template <class EntriesOf, class Key>
  Buckets(Index rows, Index rows_of_part, Index keys, const EntriesOf& entries_of, const Key& key)
      : keys_(keys), rows_of_part_(rows_of_part), parts_(chunk_count(rows, rows_of_part)) {
    while (log2_width_ < kMostLog2Width && chunk_count(keys, width()) > kEnoughBuckets) ++log2_width_;
    for_each_chunk(rows, rows_of_part, [&](Index k, Index begin, Index end) {
      const auto for_each_entry = entries_of(k, begin, end);
      SortedPart& part = parts_[k];
      std::vector<Offset> next(std::size_t(size()) + 1, 0);
      for_each_entry([&](const Entry& entry) { ++next[bucket_of(key(entry)) + 1]; });
      std::partial_sum(next.begin(), next.end(), next.begin());
      part.starts = next;
      part.entries.resize(std::size_t(next.back()));
      for_each_entry([&, entries = part.entries.data(), next = next.data()](const Entry& entry) {
        const Index bucket = bucket_of(key(entry));
        entries[next[bucket]++] = StoredEntry<Entry>::of(entry, begin, first_key(bucket));
      });
    });
    starts_.assign(std::size_t(size()) + 1, 0);
    for (const SortedPart& part : parts_) {
      for (Index bucket = 0; bucket < size(); ++bucket) starts_[bucket + 1] += std::ssize(part[bucket]);
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  }

  [[nodiscard]] Index size() const { return chunk_count(keys_, width()); }

  /// Returns the number of entries before the bucket.
  [[nodiscard]] Offset start(Index bucket) const { return starts_[bucket]; }

  /// Returns the smallest key that the bucket may have.
  [[nodiscard]] Index first_key(Index bucket) const { return bucket << log2_width_; }

  /// Returns where the entries of each key of the bucket begin among all sorted entries, and the end of the
  /// last ones.
  template <class Key>
  [[nodiscard]] std::vector<Offset> key_starts(Index bucket, const Key& key) const {
    std::vector<Offset> starts(std::size_t(std::min(width(), keys_ - first_key(bucket))) + 1, 0);
    for_each(bucket, [&](const Entry& entry) { ++starts[key(entry) - first_key(bucket) + 1]; });
    starts[0] = start(bucket);
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    return starts;
  }

  /// Calls `visit(entry)` for the entries of the bucket, in their given order.
  template <class Visit>
  void for_each(Index bucket, const Visit& visit) const {
    for (Index k = 0; k < index_size(parts_); ++k) {
      for (const StoredEntry<Entry>& stored : parts_[k][bucket])
        visit(stored.whole(k * rows_of_part_, first_key(bucket)));
    }
  }

 private:
  static constexpr Index kEnoughBuckets = 2048;
  static constexpr int kMostLog2Width = 16;

  struct SortedPart {
    std::vector<StoredEntry<Entry>> entries;
    std::vector<Offset> starts;  ///< where each bucket begins in `entries`, and the end

    std::span<const StoredEntry<Entry>> operator[](Index bucket) const {
      return {entries.data() + starts[bucket], entries.data() + starts[bucket + 1]};
    }
  };

  [[nodiscard]] Index width() const { return Index{1} << log2_width_; }
  [[nodiscard]] Index bucket_of(Index key) const { return key >> log2_width_; }

  Index keys_;
  Index rows_of_part_;
  int log2_width_ = 10;  ///< log₂ of the number of keys in a bucket
  std::vector<SortedPart> parts_;
  std::vector<Offset> starts_;  ///< where each bucket begins among the entries of all parts, and the end
};

}  // namespace meshorder
