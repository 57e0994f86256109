// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/csr_graph.hpp"

#include "graph/incidence.hpp"
#include "graph/traversal.hpp"
#include "support/sample_graphs.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>

namespace meshorder {
namespace {

Incidence elements_of_size(Index vertices, Index elements, int size, unsigned seed) {
  std::mt19937 random(seed);
  Incidence result;
  result.vertex_count = vertices;
  for (Index e = 0; e < elements; ++e) {
    for (int k = 0; k < size; ++k) result.vertices.push_back(static_cast<Index>(random() % vertices));
    result.offsets.push_back(static_cast<Offset>(result.vertices.size()));
  }
  return result;
}

TEST(CsrGraph, FromEdgesDropsLoopsAndRepeats) {
  const std::vector<Edge> edges{{0, 1}, {1, 0}, {2, 2}, {3, 1}};
  const CsrGraph graph = graph_from_edges(4, edges);
  test::check_graph(graph);
  EXPECT_EQ(graph.neighbours, (std::vector<Index>{1, 0, 3, 1}));
  EXPECT_EQ(graph.edge_count(), 2);
  EXPECT_THROW(graph_from_edges(2, edges), InvalidArgument);
}

TEST(CsrGraph, FromEdgesRefusesEveryEndOutOfRange) {
  for (const Index end : {-1, 3}) {
    for (const Edge edge : {Edge{0, end}, Edge{end, 0}})
      EXPECT_THROW(graph_from_edges(3, std::vector<Edge>{{1, 2}, edge}), InvalidArgument) << end;
  }
  EXPECT_EQ(graph_from_edges(3, std::vector<Edge>{{0, 2}}).edge_count(), 1);
}

TEST(TidyRows, KeepsOrDropsLoops) {
  for (const bool keeps_loops : {false, true}) {
    std::vector<Offset> starts{0, 4, 5, 7};
    std::vector<Index> columns{2, 0, 1, 0, 1, 2, 0};
    tidy_rows(starts, columns, keeps_loops);
    EXPECT_EQ(starts, keeps_loops ? (std::vector<Offset>{0, 3, 4, 6}) : (std::vector<Offset>{0, 2, 2, 3}));
    EXPECT_EQ(columns, keeps_loops ? (std::vector<Index>{0, 1, 2, 1, 0, 2}) : (std::vector<Index>{1, 2, 0}));
  }
}

TEST(VertexGraph, JoinsExactlyThePairsOfACommonElement) {
  const Incidence elements = elements_of_size(50, 60, 4, 1);
  std::set<std::pair<Index, Index>> pairs;
  for (Index e = 0; e < elements.size(); ++e) {
    for (const Index a : elements[e]) {
      for (const Index b : elements[e]) {
        if (a != b) pairs.emplace(a, b);
      }
    }
  }
  const CsrGraph graph = joined_vertices(elements);
  test::check_graph(graph);
  std::set<std::pair<Index, Index>> found;
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) found.emplace(v, u);
  }
  EXPECT_EQ(found, pairs);
}

constexpr Index kMany = 200000;  // so many that random vertices are sorted by another algorithm

TEST(Transposed, HasTheElementsAtEachOfManyVerticesThatLieAnywhere) {
  const Incidence elements = elements_of_size(kMany, 50000, 4, 4);
  std::vector<std::vector<Index>> at_vertex(kMany);
  for (Index e = 0; e < elements.size(); ++e) {
    for (const Index v : elements[e]) at_vertex[v].push_back(e);
  }
  const Incidence found = transposed(elements);
  ASSERT_EQ(found.size(), kMany);
  EXPECT_EQ(found.vertex_count, elements.size());
  for (Index v = 0; v < kMany; ++v)
    ASSERT_EQ(std::vector<Index>(found[v].begin(), found[v].end()), at_vertex[v]);
}

TEST(VertexGraph, OfManyVerticesThatLieAnywhereJoinsThePairsOfACommonElement) {
  const Incidence elements = elements_of_size(kMany, 50000, 4, 5);
  std::vector<Edge> edges;
  for (Index e = 0; e < elements.size(); ++e) {
    for (const Index a : elements[e]) {
      for (const Index b : elements[e]) edges.push_back({a, b});
    }
  }
  const CsrGraph graph = joined_vertices(elements);
  test::check_graph(graph);
  EXPECT_EQ(graph, graph_from_edges(kMany, edges));
}

TEST(DualGraphByVertex, JoinsExactlyTheElementsThatShareAVertex) {
  const Incidence elements = elements_of_size(80, 40, 3, 2);
  const CsrGraph dual = joined_by_vertex(elements);
  test::check_graph(dual);
  for (Index e = 0; e < elements.size(); ++e) {
    for (Index f = 0; f < elements.size(); ++f) {
      const std::set<Index> mine(elements[e].begin(), elements[e].end());
      bool share = false;
      for (const Index v : elements[f]) share = share || mine.contains(v);
      const auto row = dual[e];
      EXPECT_EQ(std::find(row.begin(), row.end(), f) != row.end(), share && e != f);
    }
  }
}

TEST(Renumbered, KeepsEveryEdge) {
  const CsrGraph graph = joined_vertices(elements_of_size(30, 30, 3, 3));
  std::vector<Index> reversed(30);
  for (Index v = 0; v < 30; ++v) reversed[v] = 29 - v;
  const CsrGraph renamed = renumbered(graph, reversed);
  test::check_graph(renamed);
  EXPECT_NE(renamed, graph);
  EXPECT_EQ(renumbered(renamed, reversed), graph);
}

TEST(Renumbered, SortsRowsOfFewAndOfManyNeighbours) {
  for (const Index n : {2, 20, 33, 34, 300}) {
    const CsrGraph graph = test::star(n);
    std::vector<Index> names = index_range(0, n);
    std::shuffle(names.begin(), names.end(), std::mt19937(7));
    const CsrGraph renamed = renumbered(graph, names);
    test::check_graph(renamed);
    EXPECT_EQ(renamed.degree(names[0]), n - 1);
  }
}

TEST(Components, LargestFirstThenBySmallestVertex) {
  const std::vector<Edge> edges{{1, 2}, {5, 6}, {6, 7}, {3, 4}};
  const CsrGraph graph = graph_from_edges(9, edges);
  const std::vector<std::vector<Index>> expected{{5, 6, 7}, {1, 2}, {3, 4}, {0}, {8}};
  EXPECT_EQ(connected_components(graph), expected);
  const ComponentCounts counts = component_counts(graph);
  EXPECT_EQ(counts.components, 5);
  EXPECT_EQ(counts.isolated, 2);
}

TEST(InducedSubgraph, DropsEdgesThatLeave) {
  const std::vector<Edge> edges{{0, 1}, {1, 2}, {2, 3}};
  const CsrGraph path = graph_from_edges(4, edges);
  const std::vector<Index> some{3, 2, 0};
  const CsrGraph part = induced_subgraph(path, some);
  test::check_graph(part);
  EXPECT_EQ(part.neighbours, (std::vector<Index>{1, 0}));
}

}  // namespace
}  // namespace meshorder
