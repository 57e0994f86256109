// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/partition.hpp"

#include "distributed/order/balance.hpp"
#include "distributed/order/curve.hpp"
#include "mesh/procedural.hpp"
#include "slices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace meshorder::distributed {
namespace {

/// How many vertices each part has.
std::vector<std::int64_t> sizes_of(const Communicator& communicator, const std::vector<Index>& part_of,
                                   Index parts) {
  std::vector<std::int64_t> sizes(static_cast<std::size_t>(parts), 0);
  for (const Index part : part_of) ++sizes[static_cast<std::size_t>(part)];
  return communicator.sums(sizes);
}

GlobalIndex cut_of(const Communicator& communicator, const GlobalGraph& graph,
                   const std::vector<Index>& part_of, Index parts) {
  const Halo halo(communicator, graph.layout, ghosts(graph, communicator.rank()));
  return order_of_parts(communicator, graph, {halo, graph.layout.begin(communicator.rank()), part_of}, parts)
      .cut;
}

class Partitions : public testing::TestWithParam<Index> {};

TEST_P(Partitions, OfPtScotchAreBalancedAndCutFewerEdges) {
  const Communicator communicator;
  const Index parts = GetParam();
  const GlobalGraph graph = test::graph_in_file(communicator, make_ball({.size = 16}));
  const Partition scotch = partitioned(communicator, graph, parts, Partitioner::ptscotch);
  EXPECT_EQ(scotch.by, Partitioner::ptscotch) << scotch.reason;
  const std::vector<std::int64_t> sizes = sizes_of(communicator, scotch.part_of, parts);
  EXPECT_GT(*std::min_element(sizes.begin(), sizes.end()), 0);
  EXPECT_LE(static_cast<double>(*std::max_element(sizes.begin(), sizes.end())), 1.03 * 4913 / parts + 1);

  // ranges of a lattice's rows are slabs
  const Partition ranges = partitioned(communicator, graph, parts, Partitioner::hilbert);
  const std::vector<std::int64_t> shares = sizes_of(communicator, ranges.part_of, parts);
  EXPECT_LE(*std::max_element(shares.begin(), shares.end()) - *std::min_element(shares.begin(), shares.end()),
            1);
  EXPECT_LE(cut_of(communicator, graph, scotch.part_of, parts),
            cut_of(communicator, graph, ranges.part_of, parts));
}

TEST_P(Partitions, OfPtScotchAreThoseOfTheBetterStrategy) {
  const Communicator communicator;
  const GlobalGraph graph = test::graph_in_file(communicator, make_ball({.size = 18}));
  const Partition best = partitioned(communicator, graph, GetParam(), Partitioner::ptscotch);
  const GlobalIndex cut = cut_of(communicator, graph, best.part_of, GetParam());
  bool is_of_one = false;
  for (const ScotchStrategy strategy : {ScotchStrategy::speed, ScotchStrategy::quality}) {
    std::vector<Index> part_of;
    ASSERT_TRUE(cut_by_ptscotch(communicator, graph, GetParam(), {}, strategy, part_of));
    EXPECT_LE(cut, cut_of(communicator, graph, part_of, GetParam()));
    is_of_one = is_of_one || communicator.sum(GlobalIndex{part_of == best.part_of ? 0 : 1}) == 0;
  }
  EXPECT_TRUE(is_of_one);
}

TEST_P(Partitions, OfPtScotchAreTheSameAgain) {
  const Communicator communicator;
  const GlobalGraph graph = test::graph_in_file(communicator, make_ball({.size = 16}));
  const Partition first = partitioned(communicator, graph, GetParam(), Partitioner::ptscotch);
  for (int k = 0; k < 3; ++k) {
    const Partition again = partitioned(communicator, graph, GetParam(), Partitioner::ptscotch);
    EXPECT_EQ(again.part_of, first.part_of);
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, Partitions, testing::Values(2, 5, 16));

TEST(Partition, OfSmallGraphsIsTheHilbertCut) {
  const Communicator communicator;
  const GlobalGraph graph = test::graph_in_file(communicator, make_grid({.size = 3}));  // 64 vertices
  const Partition partition = partitioned(communicator, graph, 3, Partitioner::ptscotch);
  EXPECT_EQ(partition.by, Partitioner::hilbert);
  EXPECT_NE(partition.reason, "");
  EXPECT_EQ(partition.part_of, partitioned(communicator, graph, 3, Partitioner::hilbert).part_of);
}

TEST(Partition, ByWeightsHasEquallyHeavyParts) {
  const Communicator communicator;
  const GlobalGraph graph = test::graph_in_file(communicator, make_ball({.size = 16}));
  const int rank = communicator.rank();
  std::vector<GlobalIndex> weights;  // a third is nine times as heavy as the others
  for (GlobalIndex v = graph.layout.begin(rank); v < graph.layout.end(rank); ++v)
    weights.push_back(3 * v < graph.layout.size() ? 9 : 1);
  for (const Partitioner by : {Partitioner::ptscotch, Partitioner::hilbert}) {
    for (const Index parts : {2, 5}) {
      const Partition even = partitioned(communicator, graph, parts, by);
      const Partition weighed = partitioned(communicator, graph, parts, by, weights);
      EXPECT_EQ(weighed.by, by);
      EXPECT_GT(imbalance_of(communicator, even.part_of, weights, parts), 1.1);
      EXPECT_LE(imbalance_of(communicator, weighed.part_of, weights, parts), 1.03);
      EXPECT_GT(imbalance_of(communicator, weighed.part_of, {}, parts), 1.1);
    }
  }
  const Partition alike =
      partitioned(communicator, graph, 7, Partitioner::hilbert, std::vector<GlobalIndex>(weights.size(), 3));
  EXPECT_LE(imbalance_of(communicator, alike.part_of, {}, 7), 702.0 * 7 / 4913);
}

TEST(Balance, SharesElementsOutAmongTheirVertices) {
  const Communicator communicator;
  // each rank has the same triangle and line
  const Layout layout = Layout::even(4, communicator.size());
  Rows elements;
  elements.entries = {0, 1, 2, 1, 3};
  elements.offsets = {0, 3, 5};
  const std::vector<GlobalIndex> shares = shares_in_elements(communicator, layout, elements);
  const std::vector<GlobalIndex> of_rank{kElementWeight / 3, kElementWeight / 3 + kElementWeight / 2,
                                         kElementWeight / 3, kElementWeight / 2};
  ASSERT_EQ(std::ssize(shares), layout.size(communicator.rank()));
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const auto vertex = static_cast<std::size_t>(layout.begin(communicator.rank())) + k;
    EXPECT_EQ(shares[k], communicator.size() * of_rank[vertex]);
  }
}

TEST(Quotient, NumbersPartsAlongAChain) {
  const Communicator communicator;
  // a path of 60 vertices; parts of 6 in disorder
  const std::vector<Index> part_at{4, 7, 0, 9, 2, 5, 1, 8, 3, 6};
  const Layout layout = Layout::even(60, communicator.size());
  GlobalGraph graph{layout, {}};
  std::vector<Index> part_of;
  for (GlobalIndex v = layout.begin(communicator.rank()); v < layout.end(communicator.rank()); ++v) {
    if (v > 0) graph.rows.entries.push_back(v - 1);
    if (v < 59) graph.rows.entries.push_back(v + 1);
    graph.rows.end_row();
    part_of.push_back(part_at[static_cast<std::size_t>(v / 6)]);
  }
  const Halo halo(communicator, layout, ghosts(graph, communicator.rank()));
  const Quotient quotient =
      order_of_parts(communicator, graph, {halo, layout.begin(communicator.rank()), part_of}, 10);
  EXPECT_EQ(quotient.cut, 9);
  std::vector<Index> along_the_path;
  for (const Index part : part_at)
    along_the_path.push_back(quotient.place_of[static_cast<std::size_t>(part)]);
  if (along_the_path.front() > along_the_path.back())
    std::reverse(along_the_path.begin(), along_the_path.end());
  EXPECT_EQ(along_the_path, index_range(0, 10));
}

TEST(Quotient, BringsPartsWithManyEdgesBetweenThemNearest) {
  const Communicator communicator;
  constexpr Index kParts = 7;
  constexpr Index kInPart = 30;
  // a part in the middle, and 6, 10, 14 … edges from it to each of the others
  const auto edges_to = [](Index part) { return 4 * part + 2; };
  const Layout layout = Layout::even(kParts * kInPart, communicator.size());
  GlobalGraph graph{layout, {}};
  std::vector<Index> part_of;
  for (GlobalIndex v = layout.begin(communicator.rank()); v < layout.end(communicator.rank()); ++v) {
    const auto part = static_cast<Index>(v / kInPart);
    const auto place = static_cast<Index>(v % kInPart);
    for (Index other = 1; other < kParts; ++other) {
      if (part == 0 && place < edges_to(other)) graph.rows.entries.push_back(other * kInPart + place);
    }
    if (part > 0 && place < edges_to(part)) graph.rows.entries.push_back(place);
    graph.rows.end_row();
    part_of.push_back(part);
  }
  const Halo halo(communicator, layout, ghosts(graph, communicator.rank()));
  const Quotient quotient =
      order_of_parts(communicator, graph, {halo, layout.begin(communicator.rank()), part_of}, kParts);
  const auto span = [&](const std::vector<Index>& places) {
    Index sum = 0;
    for (Index part = 1; part < kParts; ++part)
      sum += edges_to(part) * std::abs(places[static_cast<std::size_t>(part)] - places.front());
    return sum;
  };
  std::vector<Index> places = index_range(0, kParts);
  Index least = span(places);
  while (std::next_permutation(places.begin(), places.end())) least = std::min(least, span(places));
  EXPECT_LE(span(quotient.place_of), least + least / 20);  // the Fiedler vector alone: 1.5 · least
}

}  // namespace
}  // namespace meshorder::distributed
