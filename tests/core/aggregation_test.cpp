// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/aggregation.hpp"

#include "graph/traversal.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace meshorder {
namespace {

constexpr double kStrength = 0.1;

/// A path whose k-th edge has weight `weights[k]`.
Laplacian weighted_path(const std::vector<double>& weights) {
  const auto n = index_size(weights) + 1;
  Laplacian result;
  for (Index v = 0; v < n; ++v) {
    double sum = 0;
    for (const Index u : {v - 1, v + 1}) {
      if (u < 0 || u >= n) continue;
      result.neighbours.push_back(u);
      result.weights.push_back(weights[std::min(u, v)]);
      sum += result.weights.back();
    }
    result.offsets.push_back(static_cast<Offset>(result.neighbours.size()));
    result.diagonal.push_back(sum);
  }
  return result;
}

/// All rows in one chunk.
Aggregation aggregated(const Laplacian& laplacian) {
  return aggregate(laplacian, RowChunks::whole(laplacian.size()), kStrength);
}

TEST(Aggregation, PutsEveryVertexIntoAConnectedAggregate) {
  for (const CsrGraph& graph :
       {test::path(100), test::grid(17, 12), test::grid(7, 6, 5), test::star(50), test::complete(20),
        test::random_connected(500, 300, 1), test::preferential_attachment(500, 2, 2), test::hypercube(7)}) {
    const Aggregation aggregation = aggregated(test::combinatorial_laplacian(graph));
    ASSERT_EQ(index_size(aggregation.aggregate_of), graph.size());
    std::vector<std::vector<Index>> members(aggregation.count());
    for (Index v = 0; v < graph.size(); ++v) {
      ASSERT_GE(aggregation.aggregate_of[v], 0);
      ASSERT_LT(aggregation.aggregate_of[v], aggregation.count());
      members[aggregation.aggregate_of[v]].push_back(v);
    }
    for (const std::vector<Index>& of_one : members) {
      ASSERT_FALSE(of_one.empty());
      EXPECT_EQ(connected_components(induced_subgraph(graph, of_one)).size(), 1U);
      EXPECT_GT(of_one.size(), 1U) << "in a connected graph nothing needs to stay alone";
    }
  }
}

TEST(Aggregation, FoundsWithWholeFreeNeighbourhoodsInOrder) {
  // 0 takes 1; 2 has 1, which is taken; 3 takes 2 and 4; 6 takes 5 and 7
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(8))).aggregate_of,
            (std::vector<Index>{0, 0, 1, 1, 1, 2, 2, 2}));
  // 5 is left over and joins its only neighbour
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(6))).aggregate_of,
            (std::vector<Index>{0, 0, 1, 1, 1, 1}));
}

TEST(Aggregation, DoesNotReachAcrossWeakEdges) {
  // the middle edge is weak for both of its ends
  const Aggregation cut = aggregated(weighted_path({1, 0.01, 1}));
  EXPECT_EQ(cut.aggregate_of, (std::vector<Index>{0, 0, 1, 1}));
  // the vertex left over goes with the neighbour that pulls it more
  EXPECT_EQ(aggregated(weighted_path({1, 0.4, 0.6, 10})).aggregate_of, (std::vector<Index>{0, 0, 1, 1, 1}));
  EXPECT_EQ(aggregated(weighted_path({1, 0.6, 0.4, 10})).aggregate_of, (std::vector<Index>{0, 0, 0, 1, 1}));
}

TEST(Aggregation, KeepsToTheChunksOfRows) {
  const Laplacian laplacian = test::combinatorial_laplacian(test::grid(300, 100));
  const RowChunks chunks(laplacian);
  ASSERT_GT(chunks.count(), 1);
  const Aggregation aggregation = aggregate(laplacian, chunks, kStrength);
  EXPECT_EQ(aggregation.alone, 0);
  ASSERT_EQ(index_size(aggregation.first_of_chunk), chunks.count() + 1);
  std::set<Index> seen;
  for (Index v = 0; v < laplacian.size(); ++v) {
    const Index chunk = chunks.chunk_of(v);
    ASSERT_GE(aggregation.aggregate_of[v], aggregation.first_of_chunk[chunk]);
    ASSERT_LT(aggregation.aggregate_of[v], aggregation.first_of_chunk[chunk + 1]);
    seen.insert(aggregation.aggregate_of[v]);
  }
  EXPECT_EQ(index_size(seen), aggregation.count());
}

TEST(Aggregation, CountsWhoIsAloneInItsChunk) {
  // the hub is in the first chunk, most leaves are not
  const Laplacian laplacian = test::combinatorial_laplacian(test::star(20000));
  const RowChunks chunks(laplacian);
  ASSERT_GT(chunks.count(), 1);
  EXPECT_EQ(aggregate(laplacian, chunks, kStrength).alone, 20000 - chunks.size());
}

TEST(Aggregation, OfOneVertexIsOne) {
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(1))).count(), 1);
  EXPECT_EQ(aggregated(test::combinatorial_laplacian(test::path(0))).count(), 0);
}

}  // namespace
}  // namespace meshorder
