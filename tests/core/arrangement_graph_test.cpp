// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/arrangement_graph.hpp"

#include "metrics/edge_span.hpp"
#include "support/arrangements.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace meshorder {
namespace {

using test::arrangement_graph;

TEST(ArrangementGraph, HasTwiceTheSumOfEdgeSpansWhereVolumesAre1) {
  const CsrGraph graph = test::random_connected(60, 90, 1);
  const Permutation order = test::shuffled(60, 2);
  const auto twice_the_sum = 2 * edge_span(graph, order).mean * static_cast<double>(graph.edge_count());
  const std::vector<Index> sequence(order.new_to_old().begin(), order.new_to_old().end());
  EXPECT_NEAR(static_cast<double>(total_span(arrangement_graph(graph), sequence)), twice_the_sum, 1e-6);
}

TEST(ArrangementGraph, MeasuresFromMiddleToMiddle) {
  // 0 ═3═ 1 ─ 2 with volumes 4, 2, 5, in the order 1 0 2: middles 2, 8 and 17 half places from the start
  ArrangementGraph graph{{0, 1, 3, 4}, {1, 0, 2, 1}, {3, 3, 1, 1}, {4, 2, 5}};
  EXPECT_EQ(middles(graph, {1, 0, 2}), (std::vector<Offset>{8, 2, 17}));
  EXPECT_EQ(total_span(graph, {1, 0, 2}), 3 * 6 + 15);
}

TEST(ArrangementGraph, CoarsensIntoGroupsOfNeighbours) {
  for (const CsrGraph& fine :
       {test::grid(20, 15), test::star(50), test::complete(30), test::random_regular(300, 6, 1)}) {
    const ArrangementGraph graph = arrangement_graph(fine);
    const std::vector<Index> order = test::shuffled(fine.size(), 3).new_to_old();
    const CoarseArrangement coarse = coarsen(graph, order);
    const Index count = coarse.graph.size();
    std::vector<std::vector<Index>> members(count);
    Index groups_met = 0;
    for (const Index v : order) {
      members[coarse.group_of[v]].push_back(v);
      EXPECT_LE(coarse.group_of[v], groups_met);  // numbered by first members
      groups_met = std::max(groups_met, coarse.group_of[v] + 1);
    }
    EXPECT_EQ(groups_met, count);
    for (Index g = 0; g < count; ++g) {
      EXPECT_GE(members[g].size(), 1U);
      EXPECT_LE(members[g].size(), 8U);
      EXPECT_EQ(coarse.graph.volumes[g], index_size(members[g]));
      // in a group of several vertices, each one has a neighbour in the group
      for (const Index v : members[g]) {
        bool joined = members[g].size() == 1;
        for (const Index u : fine[v]) joined |= coarse.group_of[u] == g;
        EXPECT_TRUE(joined);
      }
    }
  }
}

TEST(ArrangementGraph, AddsUpTheEdgesBetweenGroupsAndTheirVolumes) {
  const CsrGraph fine = test::preferential_attachment(400, 3, 1);
  const ArrangementGraph graph = arrangement_graph(fine);
  const CoarseArrangement once = coarsen(graph, test::shuffled(400, 1).new_to_old());
  const CoarseArrangement twice = coarsen(once.graph, test::shuffled(once.graph.size(), 2).new_to_old());
  std::vector<Index> volumes(twice.graph.size(), 0);
  std::map<std::pair<Index, Index>, Offset> weights;
  for (Index v = 0; v < fine.size(); ++v) {
    const Index g = twice.group_of[once.group_of[v]];
    ++volumes[g];
    for (const Index u : fine[v]) {
      const Index h = twice.group_of[once.group_of[u]];
      if (g != h) ++weights[{g, h}];
    }
  }
  EXPECT_EQ(twice.graph.volumes, volumes);
  std::map<std::pair<Index, Index>, Offset> found;
  for (Index g = 0; g < twice.graph.size(); ++g) {
    for (Offset k = twice.graph.offsets[g]; k < twice.graph.offsets[g + 1]; ++k) {
      EXPECT_TRUE(found.try_emplace({g, twice.graph.neighbours[k]}, twice.graph.weight(k)).second);
    }
  }
  EXPECT_EQ(found, weights);
}

TEST(ArrangementGraph, GroupsByWeightOverDistance) {
  // 1 ═2═ 0 ─?─ 2 ═9═ 3 in the order of the numbers: 2 is twice as far from 0 as 1 is
  const auto groups = [](Offset weight) {
    const ArrangementGraph graph{
        {0, 2, 3, 5, 6}, {1, 2, 0, 0, 3, 2}, {2, weight, 2, weight, 9, 9}, {2, 2, 2, 2}};
    return coarsen(graph, {0, 1, 2, 3}).group_of;
  };
  EXPECT_EQ(groups(3), (std::vector<Index>{0, 0, 1, 1}));
  EXPECT_EQ(groups(5), (std::vector<Index>{0, 0, 0, 0}));
}

}  // namespace
}  // namespace meshorder
