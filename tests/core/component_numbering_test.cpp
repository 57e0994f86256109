// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/component_numbering.hpp"

#include "graph/traversal.hpp"
#include "support/dense.hpp"
#include "support/graph_orders.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>

namespace meshorder {
namespace {

CsrGraph mixed() {
  return test::disjoint_union({test::path(1), test::preferential_attachment(300, 2, 1), test::grid(6, 5, 4),
                               test::path(2), test::path(1), test::star(100)});
}

TEST(ComponentNumbering, HoldsEveryComponentOnce) {
  const CsrGraph graph = mixed();
  const ComponentNumbering numbering = number_components(graph);
  auto components = connected_components(graph);
  std::sort(components.begin(), components.end());  // by their smallest vertices
  ASSERT_EQ(numbering.component_count(), index_size(components));
  for (Index c = 0; c < numbering.component_count(); ++c) {
    const auto vertices = numbering.component(c);
    for (Index k = 0; k < index_size(vertices); ++k) EXPECT_EQ(numbering.number[vertices[k]], k);
    std::vector<Index> sorted(vertices.begin(), vertices.end());
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, components[c]);
  }
}

TEST(ComponentNumbering, OfAMeshIsABandWithRowsSortedByLength) {
  const CsrGraph graph = test::grid(60, 20, 20);
  const ComponentNumbering numbering = number_components(graph);
  Index widest = 0;
  Index changes = 0;
  for (Index k = 0; k < graph.size(); ++k) {
    const Index v = numbering.order[k];
    for (const Index u : graph[v]) widest = std::max(widest, std::abs(numbering.number[u] - k));
    if (k > 0 && graph.degree(v) != graph.degree(numbering.order[k - 1])) ++changes;
  }
  EXPECT_LT(widest, 2000);  // two levels of the search
  // vertices that a batch of 256 has found are sorted together, and have four different degrees
  EXPECT_LT(changes, 4 * (graph.size() / 100));
}

TEST(ComponentNumbering, IsTheSameOnAnyNumberOfThreads) {
  const std::vector<CsrGraph> graphs{test::scrambled(test::grid(40, 40, 30), 1),
                                     test::random_regular(30000, 6, 2), test::star(20000),
                                     test::preferential_attachment(20000, 3, 3), mixed()};
  for (const CsrGraph& graph : graphs) {
    ComponentNumbering expected;
    for (const int threads : {1, 2, 3, 7}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      tbb::task_arena arena(threads);
      const ComponentNumbering numbering = arena.execute([&] { return number_components(graph); });
      if (threads == 1) expected = numbering;
      EXPECT_EQ(numbering.order, expected.order) << graph.size() << " vertices, " << threads << " threads";
      EXPECT_EQ(numbering.number, expected.number) << graph.size() << " vertices, " << threads << " threads";
    }
  }
}

TEST(ComponentNumbering, GivesTheLaplacianOfEachComponent) {
  const CsrGraph graph = mixed();
  std::vector<double> weights;  // symmetric: each depends on the sum of both ends
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) weights.push_back(1 + (u + v) % 7);
  }
  const ComponentNumbering numbering = number_components(graph);
  for (Index c = 0; c < numbering.component_count(); ++c) {
    const auto vertices = numbering.component(c);
    const Eigen::MatrixXd plain = test::dense(component_laplacian(graph, {}, numbering, c));
    const Eigen::MatrixXd weighted = test::dense(component_laplacian(graph, weights, numbering, c));
    Eigen::MatrixXd expected_plain = Eigen::MatrixXd::Zero(plain.rows(), plain.cols());
    Eigen::MatrixXd expected_weighted = expected_plain;
    for (Index k = 0; k < index_size(vertices); ++k) {
      for (const Index u : graph[vertices[k]]) {
        const Index other = numbering.number[u];
        const double weight = 1 + (u + vertices[k]) % 7;
        expected_plain(k, other) -= 1;
        expected_plain(k, k) += 1;
        expected_weighted(k, other) -= weight;
        expected_weighted(k, k) += weight;
      }
    }
    EXPECT_EQ(plain, expected_plain);
    EXPECT_EQ(weighted, expected_weighted);
  }
}

}  // namespace
}  // namespace meshorder
