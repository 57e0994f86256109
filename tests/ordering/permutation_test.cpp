// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/ordering/permutation.hpp>

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(Permutation, HoldsBothDirections) {
  const auto p = Permutation::from_old_to_new({2, 0, 1});
  EXPECT_EQ(p.new_to_old(), (std::vector<Index>{1, 2, 0}));
  EXPECT_EQ(Permutation::from_new_to_old({1, 2, 0}), p);
}

TEST(Permutation, MovesRowsToTheirNewPlaces) {
  const auto p = Permutation::from_old_to_new({2, 0, 1});
  EXPECT_EQ(p.moved(std::vector<char>{'a', 'b', 'c'}), (std::vector<char>{'b', 'c', 'a'}));
  EXPECT_EQ(p.moved(std::vector<int>{1, 2, 3, 4, 5, 6}, 2), (std::vector<int>{3, 4, 5, 6, 1, 2}));
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
  EXPECT_THROW((void)Permutation::identity(3).moved(std::vector<int>{1, 2}), InvalidArgument);
}

TEST(Permutation, OfNothingIsTheIdentity) { EXPECT_TRUE(Permutation::identity(0).is_identity()); }

}  // namespace
}  // namespace meshorder
