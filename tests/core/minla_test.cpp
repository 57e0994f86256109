// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "spectral/fiedler.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace meshorder {
namespace {
using test::order_of;
using test::scrambled;

/// Σ |rank i − rank j| over edges by its definition; exact.
double sum_of_spans(const CsrGraph& graph, const std::vector<Index>& old_to_new) {
  Offset sum = 0;
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) {
      if (u < v) sum += std::abs(old_to_new[u] - old_to_new[v]);
    }
  }
  return static_cast<double>(sum);
}

double minla(const CsrGraph& graph) { return sum_of_spans(graph, order_of(graph, "minla").old_to_new()); }

/// The least sum of spans over all n! orders.
double optimum(const CsrGraph& graph) {
  std::vector<Index> order(graph.size());
  std::iota(order.begin(), order.end(), Index{0});
  double least = std::numeric_limits<double>::max();
  do {
    least = std::min(least, sum_of_spans(graph, order));
  } while (std::next_permutation(order.begin(), order.end()));
  return least;
}

TEST(Minla, FindsTheOptimumOfSmallGraphs) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto n = static_cast<Index>(3 + seed % 6);
    const CsrGraph graph = test::random_connected(n, static_cast<Index>(seed % 7), seed);
    EXPECT_EQ(minla(graph), optimum(graph)) << "seed " << seed;
  }
}

TEST(Minla, FindsTheOptimaOfPathsCyclesStarsAndCompleteGraphs) {
  for (const Index n : {5, 30, 100, 500}) {
    const double m = n;
    EXPECT_EQ(minla(scrambled(test::path(n), 1)), m - 1);
    EXPECT_EQ(minla(scrambled(test::cycle(n), 1)), 2 * (m - 1));
    EXPECT_EQ(minla(scrambled(test::star(n), 1)), std::floor(m * m / 4));
    EXPECT_EQ(minla(scrambled(test::complete(n), 1)), m * (m * m - 1) / 6);
  }
}

TEST(Minla, ComesWithin3PercentOfTheOptimumOfHypercubes) {
  // Harper 1964: the binary order, 2^(d−1) (2^d − 1)
  for (int d = 2; d <= 10; ++d) {
    const double least = std::ldexp(std::ldexp(1, d) - 1, d - 1);
    const double sum = minla(scrambled(test::hypercube(d), 1));
    EXPECT_GE(sum, least) << d;
    EXPECT_LE(sum, 1.03 * least) << d;
  }
}

TEST(Minla, ComesWithin6PercentOfTheOptimumOfSquareGrids) {
  // Mitchison and Durbin 1986: (4 − √2)/3 n³ and lower terms
  for (const Index n : {32, 64, 100}) {
    const double least = (4 - std::sqrt(2.0)) / 3 * n * n * n;
    const double sum = minla(scrambled(test::grid(n, n), 1));
    EXPECT_LE(sum, 1.06 * least) << n;
    EXPECT_GE(sum, 0.97 * least) << n;
  }
}

TEST(Minla, ComesWithin30PercentOfTheOptimumOfBinaryTrees) {
  // Chung 1978, complete trees of k levels: 2^k (k/3 + 5/18) + (−1)^k 2/9 − 2; the sum of `fiedler` is up to
  // 30 times as large
  for (int k = 3; k <= 12; ++k) {
    const Index n = (1 << k) - 1;
    std::vector<Edge> edges;
    for (Index v = 1; v < n; ++v) edges.push_back({v, (v - 1) / 2});
    const double least = std::ldexp(k / 3.0 + 5 / 18.0, k) + (k % 2 == 0 ? 2 : -2) / 9.0 - 2;
    const double sum = minla(scrambled(graph_from_edges(n, edges), 1));
    EXPECT_GE(sum, least - 0.5) << k;
    EXPECT_LE(sum, 1.3 * least) << k;
  }
}

TEST(Minla, IsNeverWorseThanFiedler) {
  std::vector<CsrGraph> graphs{test::grid(9, 8, 7),
                               test::complete_bipartite(40, 60),
                               test::random_regular(500, 8, 1),
                               test::preferential_attachment(2000, 3, 1),
                               test::random_connected(1000, 50, 1),
                               vertex_graph(test::mixed_mesh()),
                               vertex_graph(test::tetrahedral_bar(30)),
                               vertex_graph(test::tetrahedral_bar(700)),
                               test::grid(3, 3, 900),
                               test::grid(700, 4),
                               test::path(20000),
                               test::cycle(5000),
                               test::grid(3000, 2)};
  graphs.push_back(test::disjoint_union(graphs));
  for (const CsrGraph& graph : graphs) {
    EXPECT_LE(minla(graph), sum_of_spans(graph, order_of(graph, "fiedler").old_to_new())) << graph.size();
  }
}

/// A long bar whose end is joined to the ends of two bars of half its length: a body and its legs.
CsrGraph body_with_legs(Index length, Index width) {
  const CsrGraph body = test::grid(width, width, length);
  const CsrGraph leg = test::grid(width, width, length / 2);
  const CsrGraph parts = test::disjoint_union({body, leg, leg});
  std::vector<Edge> edges;
  for (Index v = 0; v < parts.size(); ++v) {
    for (const Index u : parts[v]) edges.push_back({u, v});
  }
  const Index hip = body.size() - width * width;
  for (Index k = 0; k < width * width; ++k) {
    edges.push_back({hip + k, body.size() + k});
    edges.push_back({hip + k, body.size() + leg.size() + k});
  }
  return graph_from_edges(parts.size(), edges);
}

TEST(Minla, PutsLegsOneAfterTheOther) {
  const CsrGraph graph = body_with_legs(60, 6);
  // body, leg, leg, as they are numbered; Fiedler puts the legs side by side, which doubles their spans
  const double one_after_another = sum_of_spans(graph, Permutation::identity(graph.size()).old_to_new());
  const CsrGraph given = scrambled(graph, 1);
  EXPECT_GT(sum_of_spans(given, order_of(given, "fiedler").old_to_new()), 1.1 * one_after_another);
  EXPECT_LT(minla(given), 1.01 * one_after_another);
}

TEST(Minla, ShortensTheSpansOfMeshes) {
  const CsrGraph torus = vertex_graph(make_torus({8, 0.15, 0}));
  const CsrGraph grid = vertex_graph(make_grid({20, 0.15, 0}));
  EXPECT_LT(minla(torus), 0.97 * sum_of_spans(torus, order_of(torus, "fiedler").old_to_new()));
  EXPECT_LT(minla(grid), 0.96 * sum_of_spans(grid, order_of(grid, "fiedler").old_to_new()));
}

TEST(Minla, KeepsComponentsWhereFiedlerPutsThem) {
  const CsrGraph graph =
      scrambled(test::disjoint_union({test::path(1), test::grid(7, 5), test::star(150), test::path(2),
                                      test::path(1), test::grid(20, 9), test::cycle(3)}),
                3);
  const Order order = order_graph("minla", {graph, {}});
  const std::vector<std::vector<Index>> components = fiedler_vectors(graph).component_vertices;
  auto place = order.permutation.new_to_old().begin();
  for (const std::vector<Index>& component : components) {
    std::vector<Index> here(place, place + static_cast<std::ptrdiff_t>(component.size()));
    std::sort(here.begin(), here.end());
    EXPECT_EQ(here, component);
    place += static_cast<std::ptrdiff_t>(component.size());
  }
  EXPECT_EQ(order.fiedler.size(), components.size());
  // each component's order is as good as for the component by itself
  EXPECT_LE(minla(graph),
            minla(test::grid(20, 9)) * 1.02 + 150.0 * 150 / 4 + minla(test::grid(7, 5)) * 1.02 + 5);
}

TEST(Minla, IsTheSameForEveryNumberOfThreads) {
  const CsrGraph graph = vertex_graph(make_torus({12, 0.15, 0}));
  std::vector<Permutation> orders;
  for (const std::size_t threads : {1U, 2U, 7U}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    orders.push_back(order_of(graph, "minla"));
  }
  EXPECT_EQ(orders[0], orders[1]);
  EXPECT_EQ(orders[0], orders[2]);
}

TEST(Minla, ComesToAnEndOnGraphsThatDoNotCoarsenWell) {
  for (const CsrGraph& graph :
       {test::star(test::large(400000)), test::random_regular(test::large(40000), 10, 1),
        test::preferential_attachment(test::large(60000), 4, 1), test::complete(test::large(1500))}) {
    EXPECT_EQ(order_of(graph, "minla").size(), graph.size());
  }
}

}  // namespace
}  // namespace meshorder
