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

#include <algorithm>

namespace meshorder {
namespace {
using test::scrambled;

Permutation fiedler_order(const CsrGraph& graph, double tolerance = 0.1) {
  OrderOptions options;
  options.tolerance = tolerance;
  return order_graph("fiedler", {graph, {}}, options).permutation;
}

TEST(FiedlerOrder, PutsAScrambledPathBackEndToEnd) {
  for (const Index n : {2, 3, 10, 100}) {
    const CsrGraph path = scrambled(test::path(n), 1);
    EXPECT_EQ(edge_span(path, fiedler_order(path)), (EdgeSpan{1, 1, 0})) << n;
  }
  for (const Index n : {101, 1000, 20000}) {
    const CsrGraph path = scrambled(test::path(n), 1);
    EXPECT_EQ(edge_span(path, fiedler_order(path, 1e-6)), (EdgeSpan{1, 1, 0})) << n;
  }
}

TEST(FiedlerOrder, PutsALongGridInSlices) {
  // cosines along the longest side only: each slice is filled before the next
  const CsrGraph grid = scrambled(test::grid(60, 4, 3), 2);
  const Permutation names = test::shuffled(720, 2);
  const Permutation order = fiedler_order(grid, 1e-8);
  for (Index k = 0; k < 720; ++k) {
    const Index slice = names.new_to_old()[order.new_to_old()[k]] % 60;
    const Index first_slice = names.new_to_old()[order.new_to_old()[0]] % 60;
    ASSERT_EQ(slice, first_slice == 0 ? k / 12 : 59 - k / 12);
  }
}

TEST(FiedlerOrder, KeepsEachComponentTogetherLargestFirstIsolatedLast) {
  const CsrGraph graph = scrambled(test::disjoint_union({test::path(1), test::grid(4, 3), test::star(150),
                                                         test::path(2), test::path(1), test::grid(4, 3)}),
                                   3);
  const Order order = order_graph("fiedler", {graph, {}});
  const FiedlerVectors result = fiedler_vectors(graph);
  const std::span<const Index> sequence = order.permutation.new_to_old();
  std::size_t place = 0;
  ASSERT_EQ(order.fiedler.size(), 6U);
  for (std::size_t c = 0; c < 6; ++c) {
    const std::vector<Index>& component = result.component_vertices[c];
    EXPECT_EQ(order.fiedler[c].size, index_size(component));
    std::vector<Index> here(sequence.begin() + static_cast<Offset>(place),
                            sequence.begin() + static_cast<Offset>(place + component.size()));
    EXPECT_TRUE(std::is_sorted(
        here.begin(), here.end(),
        [&](Index a, Index b) { return std::pair(result.values[a], a) < std::pair(result.values[b], b); }))
        << "component " << c;
    std::sort(here.begin(), here.end());
    EXPECT_EQ(here, component);
    place += component.size();
  }
  EXPECT_EQ(order.fiedler[0].size, 150);
  EXPECT_EQ(order.fiedler[5].size, 1);
}

TEST(FiedlerOrder, OfAMeshHasAMeanSpanOfAboutASlice) {
  const CsrGraph graph = scrambled(vertex_graph(make_torus({8, 0.15, 0})), 4);
  const double before = edge_span(graph, Permutation::identity(graph.size())).mean;
  EXPECT_NEAR(before, graph.size() / 3.0, 0.02 * graph.size());
  // the order goes along both halves of the ring at once, 64/2 slices each: a step has 2 · 81 vertices
  EXPECT_LT(edge_span(graph, fiedler_order(graph)).mean, 1.5 * 2 * 81);
}

TEST(FiedlerOrder, OfElementsFollowsTheirDualGraphs) {
  // in a bar of cubes both dual graphs are long and thin
  const Index n = 40;
  const Mesh bar = test::tetrahedral_bar(n);
  const CellArrays cells = cell_arrays(bar);
  const CellSelection top = CellSelection::elements(cells);
  const Permutation vertices = test::shuffled(bar.vertex_count(), 1);
  for (const char* method : {"fiedler", "fiedler-facet"}) {
    const Order order =
        order_incidence(method, {top.incidence(), vertices, {}, [&] { return facet_graph(bar); }});
    ASSERT_EQ(order.fiedler.size(), 1U);
    EXPECT_TRUE(order.fiedler[0].converged);
    const auto& sequence = order.permutation.new_to_old();
    const bool rising = sequence.front() < 6;
    for (Index k = 0; k < 6 * n; ++k) {
      const Index cube = sequence[rising ? k : 6 * n - 1 - k] / 6;
      EXPECT_NEAR(cube, k / 6, 2) << method << " at " << k;
    }
  }
}

}  // namespace
}  // namespace meshorder
