// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/arrangement_graph.hpp"
#include "support/arrangements.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

namespace meshorder {
namespace {

using test::arrangement_graph;

/// A graph with the weights and volumes that two coarsenings in random order give.
ArrangementGraph uneven_graph(Index n) {
  const ArrangementGraph fine = arrangement_graph(test::random_connected(n, 3 * n, 1));
  const ArrangementGraph once = coarsen(fine, test::shuffled(n, 1).new_to_old()).graph;
  return coarsen(once, test::shuffled(once.size(), 2).new_to_old()).graph;
}

/// The least total span after a move of one vertex.
Offset least_by_one_insertion(const ArrangementGraph& graph, const std::vector<Index>& order) {
  Offset least = total_span(graph, order);
  for (Index from = 0; from < graph.size(); ++from) {
    for (Index to = 0; to < graph.size(); ++to) {
      std::vector<Index> changed = order;
      const Index v = changed[from];
      changed.erase(changed.begin() + from);
      changed.insert(changed.begin() + to, v);
      least = std::min(least, total_span(graph, changed));
    }
  }
  return least;
}

TEST(Insertions, LeaveNothingToGainByMovingOneVertex) {
  // dense enough that no search along the line stops before its end
  for (const ArrangementGraph& graph : {uneven_graph(150), arrangement_graph(test::complete_bipartite(12, 9)),
                                        arrangement_graph(test::random_connected(25, 150, 2))}) {
    std::vector<Index> order = test::shuffled(graph.size(), 1).new_to_old();
    const Offset before = total_span(graph, order);
    const Offset after = improve_by_insertions(graph, order, 1000);
    EXPECT_LT(after, before);
    EXPECT_EQ(after, total_span(graph, order));
    EXPECT_EQ(after, least_by_one_insertion(graph, order));
  }
}

TEST(Insertions, FindTheBestPlaceOfALoneVertex) {
  // a path in order, except that one end is in the middle
  const Index n = 41;
  std::vector<Index> order(n);
  for (Index k = 0; k < n; ++k) order[k] = k < 20 ? k + 1 : k == 20 ? 0 : k;
  EXPECT_EQ(improve_by_insertions(arrangement_graph(test::path(n)), order, 1), 2 * (n - 1));
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(Insertions, YieldTheSpanThatIsLeftAfterEveryPass) {
  const ArrangementGraph graph = arrangement_graph(test::grid(120, 110));  // several chunks
  std::vector<Index> order = test::shuffled(graph.size(), 5).new_to_old();
  Offset before = total_span(graph, order);
  for (const int passes : {1, 1, 2, 3}) {
    const Offset after = improve_by_insertions(graph, order, passes);
    EXPECT_EQ(after, total_span(graph, order));
    EXPECT_LT(after, before);
    before = after;
  }
  std::sort(order.begin(), order.end());
  for (Index k = 0; k < graph.size(); ++k) ASSERT_EQ(order[k], k);
}

TEST(Insertions, AreTheSameForEveryNumberOfThreads) {
  const ArrangementGraph graph = arrangement_graph(test::grid(160, 150));
  std::vector<std::vector<Index>> orders;
  for (const std::size_t threads : {1U, 2U, 7U}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    orders.push_back(test::shuffled(graph.size(), 5).new_to_old());
    improve_by_insertions(graph, orders.back(), 4);
  }
  EXPECT_EQ(orders[0], orders[1]);
  EXPECT_EQ(orders[0], orders[2]);
}

TEST(Insertions, MoveVerticesAcrossTheBordersOfChunksInLaterPasses) {
  // one vertex of a path is ten places too late, beyond the end of its chunk
  const Index n = 3 * 4096;
  std::vector<Index> order(n);
  for (Index k = 0; k < n; ++k) order[k] = k < 4090 || k > 4100 ? k : k < 4100 ? k + 1 : 4090;
  const ArrangementGraph graph = arrangement_graph(test::path(n));
  std::vector<Index> in_one_pass = order;
  EXPECT_GT(improve_by_insertions(graph, in_one_pass, 1), 2 * (n - 1));
  EXPECT_EQ(improve_by_insertions(graph, order, 2), 2 * (n - 1));
}

TEST(Insertions, OfNothingAreNothing) {
  std::vector<Index> order;
  EXPECT_EQ(improve_by_insertions(ArrangementGraph{}, order, 3), 0);
  order = {0};
  EXPECT_EQ(improve_by_insertions(arrangement_graph(test::path(1)), order, 3), 0);
  EXPECT_EQ(order, std::vector<Index>{0});
}

}  // namespace
}  // namespace meshorder
