// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/method.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>
#include <string>

namespace meshorder {
namespace {
using test::order_of;
using test::scrambled;

TEST(SmoothedBisection, BeginsAtTheEndThatIsPulledForward) {
  // 0 – 1 – … – 39: longer than a leaf
  std::vector<Index> rising(40);
  std::iota(rising.begin(), rising.end(), Index{0});
  std::vector<Index> falling(rising.rbegin(), rising.rend());
  std::vector<float> pull(40, 0);
  pull[0] = 1;
  EXPECT_EQ(smoothed_bisection(test::path(40), pull), rising);
  pull[0] = -1;
  EXPECT_EQ(smoothed_bisection(test::path(40), pull), falling);
  pull[0] = 0;
  pull[39] = 2;
  EXPECT_EQ(smoothed_bisection(test::path(40), pull), falling);
}

TEST(SmoothedBisection, PutsTheComponentFirstThatIsPulledForwardMost) {
  const CsrGraph graph = test::disjoint_union({test::path(2), test::path(3), test::path(2)});
  EXPECT_EQ(smoothed_bisection(graph, {0, -1, 0, 0, 1, 0.25F, 0}), (std::vector<Index>{4, 3, 2, 5, 6, 0, 1}));
}

TEST(SmoothedBisection, ListsEveryVertexOnce) {
  for (const CsrGraph& graph : {CsrGraph{}, test::path(1), graph_from_edges(50, {}), test::star(100),
                                test::complete(60), test::preferential_attachment(700, 2, 1),
                                test::disjoint_union({test::grid(9, 9), test::path(1), test::cycle(30)})}) {
    std::vector<Index> sequence = smoothed_bisection(graph, std::vector<float>(graph.size(), 0));
    std::sort(sequence.begin(), sequence.end());
    std::vector<Index> all(graph.size());
    std::iota(all.begin(), all.end(), Index{0});
    EXPECT_EQ(sequence, all);
  }
}

TEST(SpectralOrder, PutsAScrambledPathBackEndToEnd) {
  for (const Index n : {2, 3, 10, 100, 4000, 20000}) {
    const CsrGraph path = scrambled(test::path(n), 1);
    EXPECT_EQ(edge_span(path, order_of(path, "spectral")), (EdgeSpan{1, 1, 0})) << n;
  }
}

TEST(SpectralOrder, HasSpansNoLongerThanBisectionByMetis) {
  for (const Mesh& mesh : {make_grid({10, 0.15, 0}), make_grid({24, 0.15, 0}), make_ball({20, 0.15, 0}),
                           make_torus({9, 0.15, 0})}) {
    const CsrGraph graph = scrambled(vertex_graph(mesh), 2);
    const EdgeSpan span = edge_span(graph, order_of(graph, "spectral"));
    const EdgeSpan metis = edge_span(graph, order_of(graph, "metis-rb"));
    EXPECT_LE(span.mean_log2, metis.mean_log2) << graph.size();
    EXPECT_LE(span.mean, metis.mean) << graph.size();
  }
}

TEST(SpectralOrder, IsTheSameForAnyNumberOfThreads) {
  const CsrGraph graph = scrambled(vertex_graph(make_torus({10, 0.15, 0})), 3);
  ASSERT_GT(graph.size(), 8000);  // so many that pieces are ordered in parallel
  Permutation with_one;
  for (const std::size_t threads : {1U, 2U, 5U}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const Permutation order = order_of(graph, "spectral");
    if (threads == 1) with_one = order;
    EXPECT_EQ(order, with_one) << threads;
  }
}

TEST(SpectralOrder, KeepsComponentsTogetherLargestFirst) {
  const CsrGraph graph = test::disjoint_union(
      {test::path(3), test::grid(90, 60), test::path(1), test::cycle(8), test::grid(80, 60)});
  const std::vector<Index> sequence = order_of(graph, "spectral").new_to_old();
  // the components' vertices: 0 … 2, 3 … 5402, 5403, 5404 … 5411, 5412 … 10211
  for (Index k = 0; k < graph.size(); ++k) {
    const Index v = sequence[k];
    const int component = v < 3 ? 3 : v < 5403 ? 0 : v < 5404 ? 4 : v < 5412 ? 2 : 1;
    EXPECT_EQ(component, k < 5400 ? 0 : k < 10200 ? 1 : k < 10208 ? 2 : k < 10211 ? 3 : 4) << k;
  }
}

TEST(SpectralOrder, PutsBranchesThatEndBeforeThoseThatGoOn) {
  // three paths from vertex 0; along the Fiedler vector the two shorter ones run side by side
  std::vector<Edge> edges;
  Index n = 1;
  for (const Index length : {14000, 8000, 3000}) {
    for (Index k = 0; k < length; ++k, ++n) edges.push_back({k == 0 ? 0 : n - 1, n});
  }
  const CsrGraph branches = graph_from_edges(n, edges);
  // the mean is 1.13; it is 1.22 if the branch that continues comes first
  EXPECT_LT(edge_span(branches, order_of(branches, "spectral")).mean, 1.18);
}

/// The order of a graph that is a part of a larger one.
std::vector<Index> order_of_part(GraphRef graph, std::vector<float> pull) {
  const Permutation order = order_graph("spectral", {.graph = graph, .pull = pull}).permutation;
  return {order.new_to_old().begin(), order.new_to_old().end()};
}

TEST(SpectralOrder, BeginsAtTheEndOfAPartThatIsPulledForward) {
  for (const Index n : {40, 9000}) {  // one leaf; slabs
    std::vector<Index> rising(n);
    std::iota(rising.begin(), rising.end(), Index{0});
    std::vector<float> pull(n, 0);
    pull.front() = 1;
    EXPECT_EQ(order_of_part(test::path(n), pull), rising) << n;
    pull.front() = -1;
    EXPECT_EQ(order_of_part(test::path(n), pull), std::vector<Index>(rising.rbegin(), rising.rend())) << n;
  }
}

TEST(SpectralOrder, PutsTheComponentOfAPartFirstThatIsPulledForwardMost) {
  const CsrGraph graph = test::disjoint_union({test::path(3), test::path(2), test::path(2)});
  EXPECT_EQ(order_of_part(graph, {0, 0, -1, 0.25F, 0, 1, 0}), (std::vector<Index>{5, 6, 3, 4, 0, 1, 2}));
}

TEST(SpectralOrder, ComesToAnEndOnGraphsWithoutGoodCuts) {
  const std::vector<std::pair<std::string, CsrGraph>> graphs{
      {"star", test::star(test::large(200000))},
      {"complete graph", test::complete(test::large(4500))},
      {"complete bipartite graph", test::complete_bipartite(20, test::large(50000))},
      {"expander", test::random_regular(test::large(50000), 8, 1)},
      {"power law", test::preferential_attachment(test::large(50000), 3, 1)},
      {"hypercube", test::hypercube(13)},
      {"long path", test::path(test::large(500000))},
      {"many components",
       test::disjoint_union(std::vector<CsrGraph>(test::large(30000), test::complete(4)))}};
  for (const auto& [name, graph] : graphs) {
    EXPECT_EQ(order_of(graph, "spectral").size(), graph.size()) << name;
  }
}

}  // namespace
}  // namespace meshorder
