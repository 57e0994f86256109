// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/fiedler.hpp"

#include "mesh/procedural.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "slices.hpp"
#include "support/sample_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace meshorder::distributed {
namespace {

constexpr SharedSizes kAllTogether{.alone = 0, .few = 20};
constexpr SharedSizes kAllAlone{.alone = 1'000'000, .few = 20};

/// The result of all ranks for a graph, on each of them.
struct Found {
  Permutation order;
  std::vector<FiedlerComponent> components;
};

Found found(const Communicator& communicator, const Mesh& mesh, SharedSizes sizes,
            const OrderOptions& options = {}) {
  const GlobalGraph graph = test::graph_in_file(communicator, mesh);
  const Halo halo(communicator, graph.layout, ghosts(graph, communicator.rank()));
  std::vector<GlobalIndex> in_file(static_cast<std::size_t>(graph.rows.size()));
  std::iota(in_file.begin(), in_file.end(), graph.layout.begin(communicator.rank()));
  SharedFiedlerOrder order = fiedler_order(communicator, graph, halo, in_file, options, sizes);
  const std::vector<GlobalIndex> numbers =
      communicator.broadcast(communicator.gathered_at_root(order.new_numbers));
  return {Permutation::from_old_to_new({numbers.begin(), numbers.end()}),
          communicator.broadcast(std::move(order.components))};
}

Order serial(const Mesh& mesh, const OrderOptions& options = {}) {
  const CsrGraph graph = vertex_graph(mesh);
  return order_graph("fiedler", {.graph = graph}, options);
}

/// Separate grids of different sizes, and two isolated vertices. Numbers go to the vertices of the grids in
/// turn.
Mesh grids_in_turn(const std::vector<Index>& sizes) {
  Mesh all;
  std::vector<std::vector<Index>> number_of;
  std::vector<Mesh> grids;
  for (const Index size : sizes) {
    grids.push_back(make_grid({.size = size}));
    number_of.emplace_back();
  }
  bool is_done = false;
  for (std::size_t turn = 0; !is_done; ++turn) {
    is_done = true;
    for (std::size_t g = 0; g < grids.size(); ++g) {
      if (turn >= grids[g].points.size()) continue;
      is_done = false;
      number_of[g].push_back(all.vertex_count());
      all.points.push_back(grids[g].points[turn]);
    }
  }
  for (std::size_t g = 0; g < grids.size(); ++g) {
    for (Index c = 0; c < grids[g].cell_count(); ++c) {
      std::vector<Index> vertices;
      for (const Index v : grids[g].cells[c]) vertices.push_back(number_of[g][static_cast<std::size_t>(v)]);
      all.cells.push_back(Shape::tetrahedron, vertices);
    }
  }
  all.points.insert(all.points.end(), 2, Point{9, 9, 9});
  return all;
}

TEST(SharedFiedler, HasTheEigenvalueAndSpansOfTheSerialOne) {
  const Communicator communicator;
  // few = 20: several levels that the ranks share. 400: one, as on meshes of usual sizes
  for (const SharedSizes sizes : {kAllTogether, SharedSizes{.alone = 0, .few = 400}}) {
    for (const Mesh& mesh : {make_torus({.size = 6}), make_torus({.size = 10}), make_ball({.size = 10})}) {
      const Found together = found(communicator, mesh, sizes);
      if (!communicator.is_root()) continue;  // the root alone checks the result
      const Order alone = serial(mesh);
      ASSERT_EQ(together.components.size(), 1);
      const FiedlerComponent& component = together.components.front();
      EXPECT_EQ(component.size, mesh.vertex_count());
      EXPECT_TRUE(component.converged);
      EXPECT_LE(component.iterations, 15);
      EXPECT_NEAR(component.lambda2, alone.fiedler.front().lambda2, 0.01 * alone.fiedler.front().lambda2);
      const CsrGraph graph = vertex_graph(mesh);
      // a ball has three eigenvectors of λ₂, with different spans; any of them may be found
      const double allowed = mesh.vertex_count() == make_ball({.size = 10}).vertex_count() ? 1.06 : 1.02;
      EXPECT_LE(edge_span(graph, together.order).mean, allowed * edge_span(graph, alone.permutation).mean);
    }
  }
}

TEST(SharedFiedler, OrdersAPathFromEndToEnd) {
  const Communicator communicator;
  constexpr Index kStep = 3 * 11 * 13;  // prime to the numbers of vertices
  for (const Index n : {2, 4, 7, 64, 1000}) {
    const Found together = found(communicator, test::path(n, kStep), kAllTogether, {.tolerance = 1e-7});
    const auto at = [&](Index k) {
      return together.order.old_to_new()[static_cast<std::size_t>(Offset{k} * kStep % n)];
    };
    const bool is_forwards = at(0) == 0;
    for (Index k = 0; k < n; ++k) ASSERT_EQ(at(k), is_forwards ? k : n - 1 - k) << n;
    const double half = std::sin(std::numbers::pi / (2.0 * n));
    EXPECT_NEAR(together.components.front().lambda2, 4 * half * half, 1e-8);
  }
}

TEST(SharedFiedler, ByOneRankIsTheSerialOrder) {
  const Communicator communicator;
  for (const Mesh& mesh : {make_ball({.size = 8}), grids_in_turn({4, 7, 4}), test::mixed_mesh()}) {
    const Found by_one = found(communicator, mesh, kAllAlone);
    const Order alone = serial(mesh);
    EXPECT_EQ(by_one.order, alone.permutation);
    EXPECT_EQ(by_one.components, alone.fiedler);
  }
}

TEST(SharedFiedler, OrdersComponentAfterComponent) {
  const Communicator communicator;
  const Mesh mesh = grids_in_turn({3, 6, 3, 5});
  const Order alone = serial(mesh);
  // one rank solves the two components of size 3, all ranks solve the others
  for (const SharedSizes sizes : {kAllTogether, SharedSizes{.alone = 64, .few = 20}}) {
    const Found together = found(communicator, mesh, sizes);
    ASSERT_EQ(together.components.size(), alone.fiedler.size());
    Index end = 0;
    for (std::size_t c = 0; c < alone.fiedler.size(); ++c) {
      EXPECT_EQ(together.components[c].size, alone.fiedler[c].size);
      EXPECT_NEAR(together.components[c].lambda2, alone.fiedler[c].lambda2, 0.01 * alone.fiedler[c].lambda2);
      const Index begin = std::exchange(end, end + alone.fiedler[c].size);
      for (Index k = begin; k < end; ++k) {
        const Index vertex = together.order.new_to_old()[static_cast<std::size_t>(k)];
        const Index there = alone.permutation.old_to_new()[static_cast<std::size_t>(vertex)];
        ASSERT_TRUE(there >= begin && there < end) << c;
      }
    }
  }
}

TEST(SharedFiedler, GivesTheSignOfTheSerialOne) {
  const Communicator communicator;
  const Mesh mesh = test::path(300, 77);  // λ₂ is simple
  const Found together = found(communicator, mesh, kAllTogether, {.tolerance = 1e-7});
  EXPECT_EQ(together.order, serial(mesh, {.tolerance = 1e-7}).permutation);
}

TEST(SharedFiedler, IsTheSameWhenRepeated) {
  const Communicator communicator;
  const Mesh mesh = make_ball({.size = 9});
  const Found first = found(communicator, mesh, kAllTogether);
  for (int run = 0; run < 3; ++run) {
    const Found again = found(communicator, mesh, kAllTogether);
    EXPECT_EQ(again.order, first.order);
    EXPECT_EQ(again.components, first.components);
  }
}

TEST(SharedFiedler, TakesGraphsOfAnySort) {
  const Communicator communicator;
  Mesh star;  // only the hub's rank can aggregate
  Mesh apart;
  star.points.resize(3000);
  apart.points.resize(50);
  for (Index v = 1; v < 3000; ++v) star.cells.push_back(Shape::line, std::vector<Index>{0, v});
  for (const Mesh& mesh : {star, apart, Mesh(), test::path(4, 1), make_grid({.size = 1})}) {
    for (const SharedSizes sizes : {kAllTogether, kAllAlone})
      EXPECT_EQ(found(communicator, mesh, sizes).order.size(), mesh.vertex_count());
  }
}

TEST(SharedFiedler, RefusesAToleranceThatIsNotPositive) {
  const Communicator communicator;
  try {
    (void)found(communicator, make_grid({.size = 2}), kAllTogether, {.tolerance = 0});
    FAIL();
  } catch (const SharedError& error) {
    EXPECT_EQ(error.code(), Code::invalid_argument);
    EXPECT_THAT(error.what(), testing::HasSubstr("tolerance"));
  }
}

}  // namespace
}  // namespace meshorder::distributed
