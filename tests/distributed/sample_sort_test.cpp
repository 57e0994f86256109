// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/sample_sort.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder::distributed {
namespace {

/// The kind of entries in a test.
struct Pattern {
  const char* name;
  std::uint64_t keys;        ///< number of different keys
  bool only_odd_ranks;       ///< the others have nothing
  GlobalIndex first_number;  ///< 2^33: numbers beyond 32 bits
};

class SampleSort : public testing::TestWithParam<Pattern> {};

TEST_P(SampleSort, GivesTheSequenceOfASerialSort) {
  Communicator communicator;
  communicator.set_chunk_limit(1024);
  const Pattern& pattern = GetParam();
  Random random(static_cast<std::uint64_t>(communicator.rank()));
  std::vector<SortEntry> own;
  const bool has_any = !pattern.only_odd_ranks || communicator.rank() % 2 == 1;
  for (GlobalIndex k = 0; has_any && k < 3000; ++k)
    own.push_back(
        {random.below(pattern.keys), pattern.first_number + communicator.size() * k + communicator.rank()});

  std::vector<SortEntry> expected = communicator.gathered_at_root(own);
  std::sort(expected.begin(), expected.end());
  const std::vector<SortEntry> sorted = sample_sorted(communicator, own);
  EXPECT_EQ(communicator.gathered_at_root(sorted), expected);

  const auto total = communicator.sum(own.size());
  EXPECT_LE(sorted.size(), total * 3 / 2 / static_cast<std::size_t>(communicator.size()) + 1);
}

INSTANTIATE_TEST_SUITE_P(Patterns, SampleSort,
                         testing::Values(Pattern{"Random", UINT64_MAX, false, 0},
                                         Pattern{"AllKeysEqual", 1, false, 0},
                                         Pattern{"FewKeys", 3, false, 0},
                                         Pattern{"EmptyRanks", 1000, true, 0},
                                         Pattern{"Beyond32Bits", 100, false, GlobalIndex{1} << 33}),
                         [](const auto& test) { return test.param.name; });

TEST(SampleSort, TakesNothingAtAll) {
  const Communicator communicator;
  EXPECT_TRUE(sample_sorted(communicator, {}).empty());
}

}  // namespace
}  // namespace meshorder::distributed
