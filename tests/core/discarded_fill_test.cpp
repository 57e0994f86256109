// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"
#include "ordering/method.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

namespace meshorder {
namespace {
using test::order_of;

/// Entries of a symmetric matrix, in the rows of the graph.
using Sizes = std::vector<double>;

double size_of(const CsrGraph& graph, const Sizes& sizes, Index v, Index u) {
  for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
    if (graph.neighbours[k] == u) return sizes.empty() ? 1 : sizes[k];
  }
  return 0;
}

/// The fill that the elimination of v discards, pair by pair.
double fill_of(const CsrGraph& graph, const Sizes& sizes, Index v, const std::set<Index>& numbered) {
  double fill = 0;
  for (const Index a : graph[v]) {
    for (const Index b : graph[v]) {
      if (a >= b || numbered.contains(a) || numbered.contains(b) || size_of(graph, {}, a, b) != 0) continue;
      fill += size_of(graph, sizes, v, a) * size_of(graph, sizes, v, b);
    }
  }
  return fill;
}

/// The order by its definition, for a connected graph: of the vertices next to numbered ones, the one with
/// the least logarithm of the fill; of several, the first in `bfs`.
std::vector<Index> by_definition(const CsrGraph& graph, const Sizes& sizes) {
  const Permutation bfs = order_of(graph, "bfs");
  std::vector<Index> order;
  std::set<Index> numbered;
  std::set<Index> front{bfs.new_to_old().front()};
  while (!front.empty()) {
    const auto key = [&](Index v) {
      const double fill = fill_of(graph, sizes, v, numbered);
      return std::tuple(fill > 1e-7 ? std::floor(std::log2(fill)) : -1e9, bfs.old_to_new()[v]);
    };
    const Index v = *std::ranges::min_element(front, {}, key);
    front.erase(v);
    numbered.insert(v);
    order.push_back(v);
    for (const Index u : graph[v]) {
      if (!numbered.contains(u)) front.insert(u);
    }
  }
  return order;
}

/// Symmetric entries between 0.1 and 10 whose sizes relative to the row sums are `relative`.
struct Entries {
  Sizes given;
  Sizes relative;
};

Entries random_entries(const CsrGraph& graph, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Entries entries{Sizes(graph.neighbours.size()), Sizes(graph.neighbours.size())};
  std::vector<double> sums(graph.size(), 0.0);
  for (Index v = 0; v < graph.size(); ++v) {
    for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
      const Index u = graph.neighbours[k];
      entries.given[k] =
          u < v ? size_of(graph, entries.given, u, v) : std::pow(10, double(random() % 2000) / 1000 - 1);
      sums[v] += entries.given[k];
    }
  }
  for (Index v = 0; v < graph.size(); ++v) {
    for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
      entries.relative[k] = entries.given[k] / std::sqrt(sums[v] * sums[graph.neighbours[k]]);
    }
  }
  return entries;
}

std::vector<Index> mdf(const CsrGraph& graph, const Sizes& weights = {}) {
  const Permutation order =
      order_vertices({.offsets = graph.offsets, .neighbours = graph.neighbours, .weights = weights}, "mdf")
          .permutation;
  return {order.new_to_old().begin(), order.new_to_old().end()};
}

TEST(Mdf, IsTheOrderOfItsDefinition) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const CsrGraph graph =
        test::random_connected(static_cast<Index>(5 + 2 * seed), static_cast<Index>(4 * seed), seed);
    EXPECT_EQ(mdf(graph), by_definition(graph, {})) << seed;
    const Entries entries = random_entries(graph, seed);
    EXPECT_EQ(mdf(graph, entries.given), by_definition(graph, entries.relative)) << seed;
  }
}

TEST(Mdf, FollowsAPathAndAChainOfTriangles) {
  const CsrGraph path = test::scrambled(test::path(100), 3);
  EXPECT_EQ(mdf(path), by_definition(path, {}));
  const std::vector<Index> order = mdf(path);
  for (std::size_t k = 1; k < order.size(); ++k) EXPECT_EQ(size_of(path, {}, order[k - 1], order[k]), 1);
}

/// The number of pairs that the elimination of all vertices in an order discards.
double discarded(const CsrGraph& graph, std::span<const Index> order) {
  double sum = 0;
  std::set<Index> numbered;
  for (const Index v : order) {
    sum += fill_of(graph, {}, v, numbered);
    numbered.insert(v);
  }
  return sum;
}

TEST(Mdf, DiscardsLessThanOtherOrdersOfATetrahedralMesh) {
  const CsrGraph graph = test::scrambled(vertex_graph(test::tetrahedral_bar(7)), 5);
  const double mine = discarded(graph, mdf(graph));
  for (const char* const other : {"bfs", "rcm", "fiedler", "minla", "scrambled"}) {
    EXPECT_LT(mine, discarded(graph, order_of(graph, other).new_to_old())) << other;
  }
}

TEST(Mdf, OrdersComponentsOneByOneAndIsolatedVerticesLast) {
  const CsrGraph graph = graph_from_edges(7, std::vector<Edge>{{5, 6}, {1, 3}, {3, 4}});
  std::vector<Index> order = mdf(graph);
  EXPECT_EQ(std::vector<Index>(order.begin() + 5, order.end()), (std::vector<Index>{0, 2}));
  std::ranges::sort(order);
  for (Index v = 0; v < 7; ++v) EXPECT_EQ(order[v], v);
  EXPECT_TRUE(mdf(graph_from_edges(0, {})).empty());
}

}  // namespace
}  // namespace meshorder
