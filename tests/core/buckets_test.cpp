// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/buckets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
  EXPECT_GT(Buckets<Entry>(0, 3, kMaxIndex, entries_of, key_of).first_key(1), kMaxIndex / 4000);
  const Buckets<Entry> without_entries(9, 3, 5, entries_of, key_of);
  EXPECT_EQ(without_entries.start(without_entries.size()), 0);
  EXPECT_EQ(without_entries.key_starts(0, key_of), std::vector<Offset>(6, 0));
}

}  // namespace
}  // namespace meshorder
