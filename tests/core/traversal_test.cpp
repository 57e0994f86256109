// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/traversal.hpp"

#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder {
namespace {

/// Distances from `start` by relaxing all edges until nothing changes; −1 where there is no way.
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

TEST(BreadthFirst, LevelsAreTheDistances) {
  const CsrGraph graph = test::disjoint_union({test::random_connected(200, 60, 1), test::path(5)});
  for (const Index start : {0, 57, 199, 202}) {
    std::vector<Index> marks(graph.size(), -1);
    const BreadthFirst search = breadth_first(graph, start, marks, 3);
    const std::vector<Index> expected = distances(graph, start);
    EXPECT_EQ(search.order.front(), start);
    EXPECT_EQ(index_size(search.order), graph.size() - std::count(expected.begin(), expected.end(), -1));
    for (Index level = 0; level <= search.depth(); ++level) {
      for (Index k = search.level_start[level]; k < search.level_start[level + 1]; ++k) {
        EXPECT_EQ(expected[search.order[k]], level);
      }
    }
    for (Index v = 0; v < graph.size(); ++v) EXPECT_EQ(marks[v], expected[v] >= 0 ? 3 : -1);
  }
}

TEST(BreadthFirst, SearchesShareMarks) {
  const CsrGraph graph = test::grid(6, 5);
  std::vector<Index> marks(graph.size(), -1);
  for (Index mark = 0; mark < 4; ++mark) {
    EXPECT_EQ(index_size(breadth_first(graph, mark, marks, mark).order), graph.size());
  }
}

TEST(BreadthFirstCopy, IsTheSameGraphInTheOrderOfASearch) {
  CsrGraph graph =
      test::disjoint_union({test::path(5), test::random_connected(200, 60, 1), CsrGraph{{0, 0}, {}}});
  for (Index v = 0; v < graph.size(); v += 3) {  // rows that do not rise keep their order
    std::reverse(graph.neighbours.begin() + graph.offsets[v],
                 graph.neighbours.begin() + graph.offsets[v + 1]);
  }
  const BreadthFirstCopy copy = breadth_first_copy(graph);
  std::vector<std::vector<Index>> components;
  for (const auto& [first, end, last_level, depth] : copy.components) {
    std::vector<Index> marks(graph.size(), -1);
    const std::vector<Index> members(copy.old_numbers.begin() + first, copy.old_numbers.begin() + end);
    const BreadthFirst search = breadth_first(graph, members.front(), marks, 0);
    EXPECT_EQ(search.order, members);
    EXPECT_EQ(depth, search.depth());
    EXPECT_EQ(last_level - first, search.level_start[depth]);
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

/// What is found from the vertex of the name 0 of a connected graph, in which names decide ties.
Index found_from_zero(const CsrGraph& graph, const std::vector<Index>& names) {
  const BreadthFirstCopy copy = breadth_first_copy(renumbered(graph, names));
  std::vector<Index> marks(graph.size(), -1);
  const Index name = copy.old_numbers[pseudo_peripheral_vertex(copy, copy.components.front(), marks)];
  return static_cast<Index>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The numbers of the vertices as names, but that `start` and 0 change theirs.
std::vector<Index> with_zero_at(Index start, Index size) {
  std::vector<Index> names = index_range(0, size);
  std::swap(names[0], names[start]);
  return names;
}

TEST(PseudoPeripheralVertex, IsAnEndOfAPathAndACornerOfAGrid) {
  EXPECT_EQ(found_from_zero(test::path(1000), with_zero_at(400, 1000)), 999);
  // of two ends the one of the smaller name
  EXPECT_EQ(found_from_zero(test::path(7), {1, 2, 3, 0, 4, 5, 6}), 0);
  EXPECT_EQ(found_from_zero(test::path(7), {6, 2, 3, 0, 4, 5, 1}), 6);
  const Index corner = found_from_zero(test::grid(9, 7), with_zero_at(31, 63));
  EXPECT_TRUE(corner == 0 || corner == 8 || corner == 54 || corner == 62) << corner;
  EXPECT_EQ(found_from_zero(test::path(1), {0}), 0);
}

TEST(PseudoPeripheralVertex, SeesAtLeastAsFarAsItsStart) {
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
TEST(PseudoPeripheralVertex, LooksAtItsComponentOnly) {
  const Index n = 200000;
  const BreadthFirstCopy isolated = breadth_first_copy(graph_from_edges(n, {}));
  std::vector<Index> marks(n, -1);
  for (Index v = 0; v < n; ++v)
    ASSERT_EQ(pseudo_peripheral_vertex(isolated, isolated.components[v], marks), v);
}

}  // namespace
}  // namespace meshorder
