// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/clean_graph.hpp"
#include "graph/examine.hpp"
#include "support/refusal.hpp"
#include <meshorder/error.hpp>
#include <meshorder/order.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace meshorder {
namespace {

struct Arrays {
  std::vector<Offset> offsets;
  std::vector<Index> neighbours;
  std::vector<double> weights = {};

  [[nodiscard]] GraphView view(int base = 0) const { return {offsets, neighbours, weights, base}; }
};

/// A path of n vertices.
Arrays path(Index n) {
  Arrays arrays{{0}, {}};
  for (Index v = 0; v < n; ++v) {
    if (v > 0) arrays.neighbours.push_back(v - 1);
    if (v + 1 < n) arrays.neighbours.push_back(v + 1);
    arrays.offsets.push_back(static_cast<Offset>(arrays.neighbours.size()));
  }
  return arrays;
}

std::string fault(const GraphView& graph, Check level = Check::full) {
  return test::refusal([&] { check(graph, level); });
}

TEST(Check, AcceptsLoopsRepeatsAndUnsortedRows) {
  EXPECT_EQ(fault({}), "");
  EXPECT_EQ(fault(path(100000).view()), "");
  EXPECT_EQ(fault(Arrays{{0, 3, 4}, {1, 0, 1}, {1, 5, 1}}.view()),
            "graph: the offsets end at 4, which does not fit 3 neighbours");
  EXPECT_EQ(fault(Arrays{{0, 3, 4}, {1, 0, 1, 0}}.view()), "");  // the repeat has one counterpart
}

TEST(Check, NamesTheFault) {
  const std::vector<std::uint32_t> offsets{1, 3, 4, 6};
  const std::vector<std::int64_t> neighbours{2, 3, 1, 1, 4};
  EXPECT_EQ(fault({offsets, neighbours, {}, 1}), "graph: neighbour 1 of row 3 is 4, outside 1 … 3");
  // arrays that are used in place
  for (const Check level : {Check::full, Check::fast}) {
    EXPECT_EQ(fault(Arrays{{0, 1, 2}, {1, 2}}.view(), level),
              "graph: neighbour 0 of row 1 is 2, outside 0 … 1");
    EXPECT_EQ(fault(Arrays{{0, 1, 2}, {1, -1}}.view(), level),
              "graph: neighbour 0 of row 1 is -1, outside 0 … 1");
  }
  EXPECT_EQ(fault({offsets, neighbours}), "graph: the first offset is 1, must be the base 0");
  EXPECT_EQ(fault(Arrays{{0, 2, 1}, {1}}.view()),
            "graph: the offset of row 1 is 2, that of the next row only 1");
  EXPECT_EQ(fault(Arrays{{0, 1, 2}, {1, 0}, {1, -1}}.view()),
            "graph: weight 0 of row 1 is -1, must be positive and finite");
  EXPECT_EQ(fault(Arrays{{0, 1, 3}, {1, 0, 1}, {1, 1, std::numeric_limits<double>::quiet_NaN()}}.view()),
            "graph: weight 1 of row 1 is nan, must be positive and finite");
}

TEST(Check, FindsEveryMissingEntry) {
  const Arrays whole = path(20);
  for (std::size_t missing = 0; missing < whole.neighbours.size(); ++missing) {
    Arrays arrays = whole;
    arrays.neighbours.erase(arrays.neighbours.begin() + static_cast<std::ptrdiff_t>(missing));
    Index row = 0;
    while (whole.offsets[static_cast<std::size_t>(row) + 1] <= static_cast<Offset>(missing)) ++row;
    for (auto v = static_cast<std::size_t>(row) + 1; v < arrays.offsets.size(); ++v) --arrays.offsets[v];
    const std::string expected =
        "but row " + std::to_string(row) + " lacks " + std::to_string(whole.neighbours[missing]) + ";";
    EXPECT_NE(fault(arrays.view()).find(expected), std::string::npos) << fault(arrays.view());
    EXPECT_EQ(fault(arrays.view(), Check::fast), "");
  }
  EXPECT_EQ(fault(Arrays{{0, 1, 2}, {1, 0}, {2, 3}}.view()),
            "graph: the weight from 0 to 1 is 2, the weight back is 3");
}

TEST(Examine, GivesEveryTwoEdgesAnotherAsymmetry) {
  constexpr Index kVertices = 24;
  std::vector<std::uint64_t> of_edges;
  for (Index v = 0; v < kVertices; ++v) {
    for (Index u = v + 1; u < kVertices; ++u) {
      Arrays edge{std::vector<Offset>(kVertices + 1, 0), {u}};
      for (Index row = v + 1; row <= kVertices; ++row) edge.offsets[static_cast<std::size_t>(row)] = 1;
      of_edges.push_back(examine(graph_arrays(edge.view()), true).asymmetry);
    }
  }
  std::vector<std::uint64_t> of_pairs = of_edges;
  for (std::size_t a = 0; a < of_edges.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) of_pairs.push_back(of_edges[a] + of_edges[b]);
  }
  std::ranges::sort(of_pairs);
  EXPECT_TRUE(std::ranges::adjacent_find(of_pairs) == of_pairs.end());
  EXPECT_NE(of_pairs.front(), 0U);
}

TEST(Cleaned, SortsMergesAndMirrors) {
  const Arrays arrays{{0, 4, 4, 5}, {2, 0, 1, 2, 0}, {1, 9, 3, 2, 5}};
  const Graph graph = cleaned(arrays.view());
  EXPECT_TRUE(std::ranges::equal(graph.neighbours(), std::vector<Index>{1, 2, 0, 0}));
  EXPECT_TRUE(std::ranges::equal(graph.weights(), std::vector<double>{1.5, 4, 1.5, 4}));
  EXPECT_EQ(fault(graph), "");
  EXPECT_EQ(cleaned(graph), graph);
  EXPECT_THROW((void)cleaned(arrays.view(), Symmetry::require), InvalidArgument);
}

TEST(Cleaned, UndoesWhatWasDoneToACleanGraph) {
  std::mt19937 random(3);
  Arrays messy{{0}, {}};
  const Arrays clean = path(5000);
  for (Index v = 0; v < 5000; ++v) {
    std::vector<Index> row(clean.neighbours.begin() + clean.offsets[static_cast<std::size_t>(v)],
                           clean.neighbours.begin() + clean.offsets[static_cast<std::size_t>(v) + 1]);
    row.insert(row.end(), {v, row.front(), row.front()});
    std::shuffle(row.begin(), row.end(), random);
    messy.neighbours.insert(messy.neighbours.end(), row.begin(), row.end());
    messy.offsets.push_back(static_cast<Offset>(messy.neighbours.size()));
  }
  const Graph graph = cleaned(messy.view(), Symmetry::require, {.threads = 2});
  EXPECT_TRUE(std::ranges::equal(graph.offsets(), clean.offsets));
  EXPECT_TRUE(std::ranges::equal(graph.neighbours(), clean.neighbours));
}

TEST(Cleaned, DropsTheDiagonalOfAMatrix) {
  const Arrays clean = path(9000);
  Arrays matrix{{0}, {}, {}};
  std::vector<double> weights;
  for (Index v = 0; v < 9000; ++v) {
    for (Index u = std::max(v - 1, 0); u <= std::min(v + 1, 8999); ++u) {
      if (u == v && v % 3 == 1) continue;  // no entry on the diagonal
      matrix.neighbours.push_back(u);
      matrix.weights.push_back(u + v + 1.0);
      if (u != v) weights.push_back(u + v + 1.0);
    }
    matrix.offsets.push_back(static_cast<Offset>(matrix.neighbours.size()));
  }
  const Graph graph = cleaned(matrix.view(), Symmetry::require, {.threads = 2});
  EXPECT_TRUE(std::ranges::equal(graph.offsets(), clean.offsets));
  EXPECT_TRUE(std::ranges::equal(graph.neighbours(), clean.neighbours));
  EXPECT_TRUE(std::ranges::equal(graph.weights(), weights));
}

TEST(CleanGraph, CopiesOnlyWhatItMust) {
  const Arrays clean = path(10);
  const GraphArrays same = clean_graph(clean.view(), Check::full, Symmetry::mirror);
  EXPECT_EQ(same.offsets.data(), clean.offsets.data());
  EXPECT_EQ(same.neighbours.data(), clean.neighbours.data());
  EXPECT_TRUE(same.notes.empty());

  const std::vector<int> narrow(clean.offsets.begin(), clean.offsets.end());
  const GraphArrays widened = clean_graph({narrow, clean.neighbours}, Check::none, Symmetry::require);
  EXPECT_EQ(widened.neighbours.data(), clean.neighbours.data());
  EXPECT_EQ(widened.notes, (std::vector<std::string>{"offsets widened"}));

  Arrays loops{{0, 2, 3, 4}, {0, 1, 0, 2}};
  const GraphArrays tidy = clean_graph(loops.view(), Check::full, Symmetry::require);
  EXPECT_EQ(tidy.notes, (std::vector<std::string>{"2 loops dropped"}));
  EXPECT_EQ(tidy.neighbours.size(), 2U);
  loops.neighbours[3] = 1;
  EXPECT_THROW(clean_graph(loops.view(), Check::full, Symmetry::require), InvalidArgument);
  EXPECT_EQ(clean_graph(loops.view(), Check::fast, Symmetry::mirror).notes.back(),
            "asymmetric pattern mirrored");
}

}  // namespace
}  // namespace meshorder
