// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/traversal.hpp"

#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <vector>

namespace meshorder {
namespace {

/// Distances from `start` by relaxing all edges until nothing changes; −1 for unreachable vertices.
std::vector<Index> distances(const CsrGraph& graph, Index start) {
  std::vector<Index> result(graph.size(), -1);
  result[start] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (Index v = 0; v < graph.size(); ++v) {
      for (const Index u : graph[v]) {
        if (result[u] >= 0 && (result[v] < 0 || result[u] + 1 < result[v])) {
          result[v] = result[u] + 1;
          changed = true;
        }
      }
    }
  }
  return result;
}

/// The vertices of a component in the order of a serial breadth-first search.
std::vector<Index> searched(const CsrGraph& graph, Index start, LevelSearch::Arrange arrange) {
  std::vector<Index> order{start};
  std::vector<bool> found(graph.size(), false);
  found[start] = true;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t first = order.size();
    for (const Index u : graph[order[k]]) {
      if (!found[u]) order.push_back(u);
      found[u] = true;
    }
    if (arrange != nullptr) arrange(graph, std::span(order).subspan(first));
  }
  return order;
}

/// The vertices that a search finds, in its order.
std::vector<Index> found_by(LevelSearch& search, Index start, Index size,
                            LevelSearch::Arrange arrange = nullptr) {
  std::vector<Index> places(size);
  places.resize(search.run(start, places, arrange));
  for (Index k = 0; k < index_size(places); ++k) EXPECT_EQ(search.place_of()[places[k]], k);
  return places;
}

TEST(LevelSearch, LevelsAreTheDistances) {
  const CsrGraph graph = test::disjoint_union({test::random_connected(200, 60, 1), test::path(5)});
  for (const Index start : {0, 57, 199, 202}) {
    LevelSearch search(graph);
    const std::vector<Index> order = found_by(search, start, graph.size());
    const std::vector<Index> expected = distances(graph, start);
    EXPECT_EQ(order, searched(graph, start, nullptr));
    EXPECT_EQ(index_size(order), graph.size() - std::count(expected.begin(), expected.end(), -1));
    for (Index level = 0; level <= search.depth(); ++level) {
      for (Index k = search.level_start()[level]; k < search.level_start()[level + 1]; ++k)
        EXPECT_EQ(expected[order[k]], level);
    }
    for (Index v = 0; v < graph.size(); ++v) EXPECT_EQ(search.has_found(v), expected[v] >= 0);
  }
}

TEST(LevelSearch, FindsAgainWhatItHasForgotten) {
  const CsrGraph graph = test::disjoint_union({test::grid(6, 5), test::path(4)});
  LevelSearch search(graph);
  EXPECT_EQ(found_by(search, 32, 4), searched(graph, 32, nullptr));
  for (const Index start : {0, 7, 29}) {
    EXPECT_EQ(found_by(search, start, 30), searched(graph, start, nullptr));
    search.forget(0, 30);
  }
  EXPECT_TRUE(search.has_found(30));
}

/// A vertex joined to `many` others, each of which is joined to the same `few`.
CsrGraph crowded(Index many, Index few) {
  std::vector<Edge> edges;
  for (Index v = 1; v <= many; ++v) {
    edges.push_back({0, v});
    for (Index k = 0; k < few; ++k) edges.push_back({v, many + 1 + k});
  }
  return graph_from_edges(1 + many + few, edges);
}

TEST(LevelSearch, IsThatOfOneThreadOnAnyNumber) {
  const LevelSearch::Arrange backwards = [](GraphRef, std::span<Index> found) {
    std::ranges::reverse(found);
  };
  // levels of tens of thousands of vertices, whose neighbours lie in many chunks
  for (const CsrGraph& graph :
       {test::random_connected(60000, 200000, 3), test::grid(80, 80, 8),
        test::disjoint_union({test::path(3), test::random_connected(20000, 50000, 4)}), crowded(5000, 96),
        crowded(30000, 1)}) {
    for (const LevelSearch::Arrange arrange : {LevelSearch::Arrange(nullptr), backwards}) {
      const std::vector<Index> expected = searched(graph, graph.size() - 5, arrange);
      for (const std::size_t threads : {1, 2, 3, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        tbb::task_arena arena(static_cast<int>(threads));
        LevelSearch search(graph);
        EXPECT_EQ(arena.execute([&] { return found_by(search, graph.size() - 5, graph.size(), arrange); }),
                  expected)
            << threads << " threads";
      }
    }
  }
}

TEST(LevelSearch, FillsPlacesFromAnyOn) {
  const CsrGraph graph = test::disjoint_union({test::grid(6, 5), test::path(4)});
  LevelSearch search(graph);
  std::vector<Index> places(34);
  EXPECT_EQ(search.run(31, places), 4);
  EXPECT_EQ(search.run(0, places, nullptr, 4), 34);
  EXPECT_EQ(std::vector<Index>(places.begin() + 4, places.end()), searched(graph, 0, nullptr));
  EXPECT_EQ(search.level_start().front(), 4);
  EXPECT_EQ(search.level_start().back(), 34);
  for (Index k = 0; k < 34; ++k) EXPECT_EQ(search.place_of()[places[k]], k);
}

TEST(BreadthFirstCopy, IsTheSameOnAnyNumberOfThreads) {
  const CsrGraph graph = test::disjoint_union(
      {test::path(7), test::random_connected(40000, 90000, 5), CsrGraph{{0, 0}, {}}, test::grid(50, 50, 4)});
  const BreadthFirstCopy expected = [&] {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    return breadth_first_copy(graph);
  }();
  for (const std::size_t threads : {2, 3, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(static_cast<int>(threads));
    const BreadthFirstCopy copy = arena.execute([&] { return breadth_first_copy(graph); });
    EXPECT_EQ(copy.old_numbers, expected.old_numbers);
    EXPECT_EQ(copy.offsets, expected.offsets);
    EXPECT_TRUE(std::ranges::equal(copy.graph().neighbours, expected.graph().neighbours));
    ASSERT_EQ(copy.components.size(), expected.components.size());
    for (std::size_t c = 0; c < copy.components.size(); ++c) {
      EXPECT_EQ(copy.components[c].first, expected.components[c].first);
      EXPECT_EQ(copy.components[c].end, expected.components[c].end);
      EXPECT_EQ(copy.components[c].last_level, expected.components[c].last_level);
      EXPECT_EQ(copy.components[c].depth, expected.components[c].depth);
    }
  }
}

TEST(BreadthFirstCopy, IsTheSameGraphInTheOrderOfASearch) {
  CsrGraph graph =
      test::disjoint_union({test::path(5), test::random_connected(200, 60, 1), CsrGraph{{0, 0}, {}}});
  for (Index v = 0; v < graph.size(); v += 3) {  // rows that descend must keep their order
    std::reverse(graph.neighbours.begin() + graph.offsets[v],
                 graph.neighbours.begin() + graph.offsets[v + 1]);
  }
  const BreadthFirstCopy copy = breadth_first_copy(graph);
  std::vector<std::vector<Index>> components;
  for (const auto& [first, end, last_level, depth] : copy.components) {
    const std::vector<Index> members(copy.old_numbers.begin() + first, copy.old_numbers.begin() + end);
    LevelSearch search(graph);
    EXPECT_EQ(found_by(search, members.front(), graph.size()), members);
    EXPECT_EQ(depth, search.depth());
    EXPECT_EQ(last_level - first, search.level_start()[depth]);
    components.push_back(members);
    std::sort(components.back().begin(), components.back().end());
  }
  EXPECT_EQ(components, connected_components(graph));
  for (Index k = 0; k < graph.size(); ++k) {
    std::vector<Index> row;
    for (const Index u : copy.graph()[k]) row.push_back(copy.old_numbers[u]);
    const auto expected = graph[copy.old_numbers[k]];
    EXPECT_EQ(row, std::vector<Index>(expected.begin(), expected.end()));
  }
}

/// The vertex that a search from the vertex of name 0 finds in a connected graph. Names break ties.
Index found_from_zero(const CsrGraph& graph, const std::vector<Index>& names) {
  const BreadthFirstCopy copy = breadth_first_copy(renumbered(graph, names));
  LevelSearch search(copy.graph());
  const std::vector<Index> order = search_from_rim(copy, copy.components.front(), search);
  EXPECT_EQ(order, searched({copy.offsets, {copy.graph().neighbours.begin(), copy.graph().neighbours.end()}},
                            order.front(), nullptr));
  const Index name = copy.old_numbers[order.front()];
  return static_cast<Index>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The numbers of the vertices as names, with those of `start` and 0 swapped.
std::vector<Index> with_zero_at(Index start, Index size) {
  std::vector<Index> names = index_range(0, size);
  std::swap(names[0], names[start]);
  return names;
}

TEST(SearchFromTheRim, IsAnEndOfAPathAndACornerOfAGrid) {
  EXPECT_EQ(found_from_zero(test::path(1000), with_zero_at(400, 1000)), 999);
  // the end with the smaller name
  EXPECT_EQ(found_from_zero(test::path(7), {1, 2, 3, 0, 4, 5, 6}), 0);
  EXPECT_EQ(found_from_zero(test::path(7), {6, 2, 3, 0, 4, 5, 1}), 6);
  const Index corner = found_from_zero(test::grid(9, 7), with_zero_at(31, 63));
  EXPECT_TRUE(corner == 0 || corner == 8 || corner == 54 || corner == 62) << corner;
  EXPECT_EQ(found_from_zero(test::path(1), {0}), 0);
}

TEST(SearchFromTheRim, SeesAtLeastAsFarAsItsStart) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const CsrGraph graph = test::random_connected(150, 20, seed);
    const Index start = 75;
    const std::vector<Index> from_start = distances(graph, start);
    const std::vector<Index> from_found = distances(graph, found_from_zero(graph, with_zero_at(start, 150)));
    EXPECT_GE(*std::max_element(from_found.begin(), from_found.end()),
              *std::max_element(from_start.begin(), from_start.end()));
  }
}

// with work that grows with the whole graph this would take minutes
TEST(SearchFromTheRim, LooksAtItsComponentOnly) {
  const Index n = 200000;
  const BreadthFirstCopy isolated = breadth_first_copy(graph_from_edges(n, {}));
  LevelSearch search(isolated.graph());
  for (Index v = 0; v < n; ++v)
    ASSERT_EQ(search_from_rim(isolated, isolated.components[v], search), std::vector<Index>{v});
}

}  // namespace
}  // namespace meshorder
