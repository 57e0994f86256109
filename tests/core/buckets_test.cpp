// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/buckets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>

namespace meshorder {
namespace {

using Entry = std::pair<Index, int>;  // a key and a number

Index key_of(const Entry& entry) { return entry.first; }

/// Parts of any size, some of them empty.
std::vector<std::vector<Entry>> parts_with(Index keys, std::size_t parts, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::vector<Entry>> result(parts);
  int number = 0;
  for (std::vector<Entry>& part : result) {
    part.resize(random() % 2 == 0 ? 0 : random() % 3000);
    for (Entry& entry : part) entry = {static_cast<Index>(random() % static_cast<unsigned>(keys)), number++};
  }
  return result;
}

TEST(Buckets, SortedOneByOneSortAllAndKeepThoseOfAKeyAsTheyCame) {
  for (const Index keys : {1, 7, 1024, 1025, 300000, 3000000}) {
    const std::vector<std::vector<Entry>> parts = parts_with(keys, 40, static_cast<unsigned>(keys));
    const auto entries_of = [&](Index part, Index begin, Index end) {
      EXPECT_EQ(std::pair(begin, end), std::pair(3 * part, std::min(3 * part + 3, 118)));
      return [&, part](const auto& call) { std::ranges::for_each(parts[part], call); };
    };
    const Buckets<Entry> buckets(118, 3, keys, entries_of, key_of);
    std::vector<Entry> sorted;
    for (Index bucket = 0; bucket < buckets.size(); ++bucket) {
      ASSERT_EQ(buckets.start(bucket), std::ssize(sorted));
      const std::vector<Offset> starts = buckets.key_starts(bucket, key_of);
      sorted.resize(starts.back());
      std::vector<Offset> next = starts;
      buckets.for_each(bucket, [&](const Entry& entry) {
        sorted[next[entry.first - buckets.first_key(bucket)]++] = entry;
      });
      ASSERT_TRUE(std::equal(next.begin(), next.end() - 1, starts.begin() + 1)) << "a key has more or fewer";
    }
    std::vector<Entry> expected;
    for (const std::vector<Entry>& part : parts) expected.insert(expected.end(), part.begin(), part.end());
    std::ranges::stable_sort(expected, {}, key_of);
    EXPECT_EQ(sorted, expected) << keys << " keys";
  }
}

TEST(Buckets, OfNothingAreEmpty) {
  const auto entries_of = [](Index, Index, Index) { return [](const auto& /*call*/) {}; };
  EXPECT_EQ(Buckets<Entry>(0, 3, 0, entries_of, key_of).size(), 0);
  EXPECT_EQ(Buckets<Entry>(0, 3, kMaxIndex, entries_of, key_of).first_key(1), 65536);
  const Buckets<Entry> without_entries(9, 3, 5, entries_of, key_of);
  EXPECT_EQ(without_entries.start(without_entries.size()), 0);
  EXPECT_EQ(without_entries.key_starts(0, key_of), std::vector<Offset>(6, 0));
}

/// An entry that is stored in two bytes for each number.
struct Cell {
  Index row;
  Index key;

  bool operator==(const Cell&) const = default;
};

}  // namespace

template <>
struct StoredEntry<Cell> {
  std::uint16_t row;
  std::uint16_t key;

  static StoredEntry of(Cell cell, Index first_row, Index first_key) {
    return {static_cast<std::uint16_t>(cell.row - first_row),
            static_cast<std::uint16_t>(cell.key - first_key)};
  }
  [[nodiscard]] Cell whole(Index first_row, Index first_key) const {
    return {first_row + row, first_key + key};
  }
};

namespace {

TEST(Buckets, ReturnWholeEntriesOfWhichTheyStoreAPart) {
  constexpr Index kRows = 200000;
  for (const Index keys : {70000, 200000000, kMaxIndex}) {
    const auto cell_of = [&](Offset row) {
      return Cell{static_cast<Index>(row), static_cast<Index>(row * 7919 * 10007 % keys)};
    };
    const auto entries_of = [&](Index /*part*/, Index begin, Index end) {
      return [&, begin, end](const auto& call) {
        for (Index row = begin; row < end; ++row) call(cell_of(row));
      };
    };
    const Buckets<Cell> buckets(kRows, 65536, keys, entries_of, [](const Cell& cell) { return cell.key; });
    Index found = 0;
    for (Index bucket = 0; bucket < buckets.size(); ++bucket) {
      buckets.for_each(bucket, [&](const Cell& cell) {
        ASSERT_EQ(cell, cell_of(cell.row));
        ++found;
      });
    }
    EXPECT_EQ(found, kRows) << keys << " keys";
  }
}

}  // namespace
}  // namespace meshorder
