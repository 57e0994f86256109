// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/moved.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/permutation.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace meshorder {
namespace {

TEST(Permutation, HoldsBothDirections) {
  const auto p = Permutation::from_old_to_new({2, 0, 1});
  EXPECT_THAT(p.new_to_old(), testing::ElementsAre(1, 2, 0));
  EXPECT_EQ(Permutation::from_new_to_old({1, 2, 0}), p);
}

TEST(Permutation, MovesRowsToTheirNewPlaces) {
  const auto p = Permutation::from_old_to_new({2, 0, 1});
  EXPECT_EQ(moved(p, std::vector<char>{'a', 'b', 'c'}), (std::vector<char>{'b', 'c', 'a'}));
  EXPECT_EQ(moved(p, std::vector<int>{1, 2, 3, 4, 5, 6}, 2), (std::vector<int>{3, 4, 5, 6, 1, 2}));
}

TEST(Permutation, InverseUndoesAndThenChains) {
  const auto p = Permutation::from_old_to_new({2, 0, 1});
  const auto q = Permutation::from_old_to_new({1, 0, 2});
  EXPECT_TRUE(p.then(p.inverse()).is_identity());
  EXPECT_EQ(p.then(q).old_to_new(), (std::vector<Index>{2, 1, 0}));
  EXPECT_FALSE(p.is_identity());
}

TEST(Permutation, RefusesWhatIsNoBijection) {
  EXPECT_THROW(Permutation::from_old_to_new({0, 0}), InvalidArgument);
  EXPECT_THROW(Permutation::from_old_to_new({0, 2}), InvalidArgument);
  EXPECT_THROW(Permutation::from_new_to_old({-1, 0}), InvalidArgument);
  EXPECT_THROW((void)moved(Permutation::identity(3), std::vector<int>{1, 2}), InvalidArgument);
}

constexpr Index kMany = 200000;  // more than one thread takes at once

TEST(Permutation, OfManyPlacesHoldsBothDirectionsAndMovesRows) {
  const auto p = test::shuffled(kMany, 3);
  std::vector<Index> rows(2 * kMany);
  for (Index i = 0; i < kMany; ++i) {
    ASSERT_EQ(p.new_to_old()[p.old_to_new()[i]], i);
    rows[2 * i] = i;
    rows[2 * i + 1] = -i;
  }
  const std::vector<Index> result = moved(p, rows, 2);
  for (Index i = 0; i < kMany; ++i) {
    ASSERT_EQ(result[2 * p.old_to_new()[i]], i);
    ASSERT_EQ(result[2 * p.old_to_new()[i] + 1], -i);
  }
}

TEST(Permutation, NamesTheFirstFaultOfManyPlaces) {
  std::vector<Index> map = Permutation::identity(kMany).old_to_new();
  map[150000] = 5;
  map[190000] = kMany;
  try {
    (void)Permutation::from_old_to_new(map);
    FAIL() << "was taken";
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("entries 5 and 150000 are both 5"), std::string::npos)
        << error.what();
  }
}

TEST(Permutation, OfNothingIsTheIdentity) { EXPECT_TRUE(Permutation::identity(0).is_identity()); }

}  // namespace
}  // namespace meshorder
