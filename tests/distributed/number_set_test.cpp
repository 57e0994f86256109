// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/number_set.hpp"

#include "base/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace meshorder::distributed {
namespace {

TEST(NumberSet, FindsThePlacesOfItsNumbers) {
  for (const GlobalIndex first : {GlobalIndex{0}, (GlobalIndex{1} << 33) + 5}) {
    for (const std::uint64_t range : {1U, 63U, 64U, 1000U, 10'000'000U}) {  // close together, and far apart
      Random random(range);
      std::vector<GlobalIndex> numbers;
      for (int k = 0; k < 500; ++k) numbers.push_back(first + static_cast<GlobalIndex>(random.below(range)));
      const std::set<GlobalIndex> expected(numbers.begin(), numbers.end());
      const NumberSet set(numbers);
      EXPECT_THAT(set.numbers(), testing::ElementsAreArray(expected)) << range;
      for (std::size_t k = 0; k < set.numbers().size(); ++k)
        EXPECT_EQ(set.position(set.numbers()[k]), k) << range;
    }
  }
}

TEST(NumberSet, MayBeEmpty) { EXPECT_TRUE(NumberSet({}).numbers().empty()); }

}  // namespace
}  // namespace meshorder::distributed
