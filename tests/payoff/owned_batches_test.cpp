// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/owned_batches.hpp"

#include "base/random.hpp"
#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace meshorder {
namespace {

TEST(BalancedRanges, ShareTheEntriesAlike) {
  std::vector<Offset> offsets{0};
  Random random(4);
  for (Index row = 0; row < 1000; ++row) {
    offsets.push_back(offsets.back() + static_cast<Offset>(random.below(row < 200 ? 60 : 10)));
  }
  for (const Index parts : {1, 2, 3, 7, 64}) {
    const std::vector<Index> bounds = balanced_ranges(offsets, parts);
    ASSERT_EQ(index_size(bounds), parts + 1);
    EXPECT_EQ(bounds.front(), 0);
    EXPECT_EQ(bounds.back(), 1000);
    for (Index part = 0; part < parts; ++part) {
      ASSERT_LE(bounds[part], bounds[part + 1]);
      const Offset entries = offsets[bounds[part + 1]] - offsets[bounds[part]];
      EXPECT_NEAR(static_cast<double>(entries), static_cast<double>(offsets.back()) / parts, 60.0);
    }
  }
}

TEST(BalancedRanges, TakeFewerRowsThanPartsAndNoEntries) {
  EXPECT_EQ(balanced_ranges(std::vector<Offset>{0}, 3), (std::vector<Index>{0, 0, 0, 0}));
  EXPECT_EQ(balanced_ranges(std::vector<Offset>{0, 5}, 3).back(), 1);
  EXPECT_EQ(balanced_ranges(std::vector<Offset>{0, 0, 0}, 2).back(), 2);
}

/// `batches` of random vertices, most of them near each other.
AlignedVector<Index> some_vertices(Index n, Index corners, Index batches) {
  Random random(8);
  AlignedVector<Index> vertices;
  for (Index b = 0; b < batches; ++b) {
    const std::uint64_t width = b % 9 == 0 ? static_cast<std::uint64_t>(n) : 12;
    const auto from = static_cast<Index>(random.below(static_cast<std::uint64_t>(n) - width + 1));
    for (Index i = 0; i < corners * kBatch; ++i) {
      vertices.push_back(from + static_cast<Index>(random.below(width)));
    }
  }
  return vertices;
}

TEST(OwnedBatches, AddToEveryOwnedVertexWhatTheSerialKernelAdds) {
  constexpr Index kN = 501;
  constexpr Index kCorners = 3;
  const AlignedVector<Index> vertices = some_vertices(kN, kCorners, 200);
  const std::vector<Index> bounds{0, 100, 100, 350, kN};
  const std::vector<OwnedBatches> shares = owned_batches(vertices, kCorners, bounds);
  ASSERT_EQ(shares.size(), 4U);

  // for every vertex, the entries that are added to it, in order
  std::vector<std::vector<Index>> expected(kN);
  for (Index i = 0; i < index_size(vertices); ++i) expected[vertices[i]].push_back(i);
  std::vector<std::vector<Index>> actual(static_cast<std::size_t>(shares.back().room));
  std::vector<std::set<Index>> written(shares.size());
  for (std::size_t part = 0; part < shares.size(); ++part) {
    const OwnedBatches& share = shares[part];
    EXPECT_EQ(share.begin, bounds[part]);
    EXPECT_EQ(share.end, bounds[part + 1]);
    EXPECT_TRUE(std::is_sorted(share.batches.begin(), share.batches.end()));
    for (Index i = 0; i < index_size(share.batches); ++i) {
      const Index first = share.batches[i] * kCorners * kBatch;
      const Index* const targets = share.targets_of(i, vertices.data() + first, kCorners);
      for (Index k = 0; k < kCorners * kBatch; ++k) {
        ASSERT_LT(targets[k], share.room);
        actual[targets[k]].push_back(first + k);
        written[part].insert(targets[k]);
      }
    }
  }
  actual.resize(kN);
  EXPECT_EQ(actual, expected);
  // and no two shares write to the same place, spare or not
  for (std::size_t a = 0; a < written.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      for (const Index v : written[a]) EXPECT_FALSE(written[b].contains(v)) << v;
    }
  }
}

TEST(OwnedBatches, AreComputedTwiceOnlyAtTheBounds) {
  AlignedVector<Index> vertices;
  for (Index b = 0; b < 100; ++b) {
    for (Index i = 0; i < 2 * kBatch; ++i) vertices.push_back(5 * b + i);
  }
  const auto shares = owned_batches(vertices, 2, std::vector<Index>{0, 250, 511});
  EXPECT_EQ(shares[0].batches.size(), 50U);
  // batches 47, 48 and 49 reach over the bound
  EXPECT_EQ(shares[1].batches.size(), 53U);
  EXPECT_EQ(
      std::count_if(shares[0].boundary.begin(), shares[0].boundary.end(), [](Index b) { return b >= 0; }), 3);
}

TEST(OwnedBatches, AskForRoom) {
  const AlignedVector<Index> vertices(2 * kBatch, 0);
  const auto shares = owned_batches(vertices, 2, std::vector<Index>{0, 1, 2});
  const AlignedVector<double> enough = padded_zeros(shares.back().room);
  EXPECT_NO_THROW(check_room(enough, shares.back(), "test"));
  EXPECT_THROW(check_room(std::span(enough).first(enough.size() - 1), shares.back(), "test"),
               InvalidArgument);
}

}  // namespace
}  // namespace meshorder
