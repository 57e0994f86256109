// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/carried.hpp"

#include "support/refusal.hpp"
#include <meshorder/number_view.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace meshorder {
namespace {
using test::refusal;
using testing::ElementsAre;

NeighbourRows rows(const std::vector<std::vector<Index>>& lists) {
  NeighbourRows result;
  for (const auto& list : lists) {
    result.neighbours.insert(result.neighbours.end(), list.begin(), list.end());
    result.offsets.push_back(static_cast<Offset>(result.neighbours.size()));
  }
  return result;
}

TEST(Carried, VerticesThatStayKeepTheirOrder) {
  // the places were 0 … 5; the vertices at 1 and 4 are gone
  const std::vector<Index> places{5, 0, 3, 2};
  EXPECT_THAT(carried_order(places, 6, {}, {}), ElementsAre(1, 3, 2, 0));
}

TEST(Carried, NewVerticesComeAfterTheMedianOfTheirNeighbours) {
  const std::vector<Index> places{0, 1, 2, 3, 4, -1, -1};
  const std::vector<Index> added{5, 6};
  EXPECT_THAT(carried_order(places, 5, added, rows({{0, 1, 4}, {3}})), ElementsAre(0, 1, 5, 2, 3, 6, 4));
}

TEST(Carried, ChainsOfNewVerticesFollowEachOther) {
  // 3 – 4 – 5 – 6 is a chain whose end 6 is joined to 1; 7 and 8 are joined only to each other
  const std::vector<Index> places{0, 1, 2, -1, -1, -1, -1, -1, -1};
  const std::vector<Index> added{3, 4, 5, 6, 7, 8};
  const NeighbourRows of{rows({{4}, {3, 5}, {4, 6}, {5, 1}, {8}, {7}})};
  EXPECT_THAT(carried_order(places, 3, added, of), ElementsAre(0, 1, 6, 5, 4, 3, 2, 7, 8));
}

TEST(Carried, LongChainsTakeNoQuadraticTime) {
  constexpr Index kLength = 400'000;
  std::vector<Index> places(kLength, -1);
  places[0] = 0;
  std::vector<Index> added;
  NeighbourRows of;
  for (Index v = 1; v < kLength; ++v) {
    added.push_back(v);
    of.neighbours.push_back(v - 1);
    if (v + 1 < kLength) of.neighbours.push_back(v + 1);
    of.offsets.push_back(static_cast<Offset>(of.neighbours.size()));
  }
  const std::vector<Index> order = carried_order(places, 1, added, of);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end())) << "and this ends at all";
}

TEST(Carried, ReportsWhatChanged) {
  const VertexChanges changes = changes_of(std::vector<Index>{2, -1, 0, -1}, 4, 3);
  EXPECT_THAT(changes.places, ElementsAre(2, -1, 0, -1));
  EXPECT_THAT(changes.added, ElementsAre(1, 3));
  EXPECT_EQ(changes.removed, 1);
  EXPECT_THAT(changes_of(std::vector<Index>{0, 1, 2}, 3, 3).places, testing::IsEmpty()) << "nothing changed";
  EXPECT_THAT(changes_of({}, 3, 3).places, testing::IsEmpty());
  EXPECT_EQ(changes_of(std::vector<Index>{0, 1}, 2, 5).removed, 3);
}

TEST(Carried, RefusesWhatDoesNotFit) {
  const auto refused = [](const std::vector<Index>& previous, Index size, Index count) {
    return refusal([&] { (void)changes_of(previous, size, count); });
  };
  EXPECT_EQ(refused({0, 1}, 3, 3), "previous: 2 entries for 3 vertices");
  EXPECT_EQ(refused({0, 3, 1}, 3, 3), "previous: entry 1 is 3, outside -1 … 2");
  EXPECT_EQ(refused({0, 1, -2}, 3, 3), "previous: entry 2 is -2, outside -1 … 2");
  EXPECT_EQ(refused({2, 0, 2}, 3, 3), "previous: entries 0 and 2 are both 2");
  EXPECT_EQ(refused({0}, 1, 0), "previous: entry 0 is 0, but there were no vertices before");
  EXPECT_EQ(refused({}, 4, 3), "previous: it is missing; there are 4 vertices, and the last update had 3");
}

}  // namespace
}  // namespace meshorder
