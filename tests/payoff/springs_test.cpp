// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/springs.hpp"

#include "payoff/deformed.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

namespace meshorder {
namespace {

constexpr double kStiffness = 2.5;

/// Every vertex joined to the next four.
CsrGraph band_graph(Index n) {
  std::vector<Edge> edges;
  for (Index a = 0; a < n; ++a) {
    for (Index b = a + 1; b < std::min(n, a + 5); ++b) edges.push_back({b, a});
  }
  return graph_from_edges(n, edges);
}

struct Net {
  Springs springs;
  AlignedVector<double> positions;
};

Net deformed_net(Index n) {
  const test::Patch patch = test::deformed_patch(1, n - 1);
  return {springs_on_edges(band_graph(n), patch.points), patch.positions};
}

AlignedVector<double> forces_of(const Net& net) {
  AlignedVector<double> forces(net.positions.size(), 0.0);
  add_spring_forces(net.springs, kStiffness, net.positions, forces);
  return forces;
}

TEST(SpringsOnEdges, TakeEveryEdgeOnceByLargerEnd) {
  const CsrGraph graph = band_graph(13);
  const test::Patch patch = test::deformed_patch(1, 12);
  const Springs springs = springs_on_edges(graph, patch.points);
  ASSERT_EQ(springs.count, graph.edge_count());
  std::pair<Index, Index> last{-1, -1};
  for (Offset s = 0; s < springs.count; ++s) {
    const Offset place = 2 * (s / kBatch) * kBatch + s % kBatch;
    const std::pair<Index, Index> ends{springs.ends[place], springs.ends[place + kBatch]};
    EXPECT_LT(ends.first, ends.second);
    EXPECT_LT(last, std::pair(ends.second, ends.first));
    EXPECT_TRUE(std::binary_search(graph[ends.first].begin(), graph[ends.first].end(), ends.second));
    last = {ends.second, ends.first};
  }
}

TEST(SpringForces, PullAlongTheSpringByItsStretch) {
  const std::vector<Point> rest{{0, 0, 0}, {2, 0, 0}};
  const Springs springs = springs_on_edges(band_graph(2), rest);
  const AlignedVector<double> x{1, 1, 1, 0, 1, 4, 5, 0};  // 5 long, in the direction (0, 0.6, 0.8)
  AlignedVector<double> forces(8, 0.0);
  add_spring_forces(springs, kStiffness, x, forces);
  const AlignedVector<double> expected{0, 4.5, 6.0, 0, 0, -4.5, -6.0, 0};  // 2.5 · (5 − 2)
  test::expect_near(forces, expected, 1e-15);
}

TEST(SpringForces, VanishAtRest) {
  const test::Patch patch = test::deformed_patch(1, 20);
  const Net net{springs_on_edges(band_graph(21), patch.points), padded_positions(patch.points)};
  EXPECT_LT(test::largest(forces_of(net)), 1e-14);
}

TEST(SpringForces, AreMinusTheGradientOfTheEnergy) {
  Net net = deformed_net(20);
  const AlignedVector<double> actual = forces_of(net);
  AlignedVector<double> expected(net.positions.size(), 0.0);
  constexpr double kStep = 1e-5;
  for (std::size_t i = 0; i < net.positions.size(); ++i) {
    if (i % kPaddedStride == 3) continue;
    const double here = net.positions[i];
    net.positions[i] = here + kStep;
    const double above = spring_energy(net.springs, kStiffness, net.positions);
    net.positions[i] = here - kStep;
    const double below = spring_energy(net.springs, kStiffness, net.positions);
    net.positions[i] = here;
    expected[i] = (below - above) / (2 * kStep);
  }
  test::expect_near(actual, expected, 1e-8);
}

TEST(SpringForces, AreTheSameWithEveryInstructionSet) {
  for (const Index n : {2, 3, 9, 60}) {
    const Net net = deformed_net(n);
    AlignedVector<double> scalar(net.positions.size(), 0.0);
    add_spring_forces_scalar(net.springs, kStiffness, net.positions, scalar);
    test::for_each_target([&](const char* target) {
      SCOPED_TRACE(target);
      test::expect_near(forces_of(net), scalar, 1e-12);
    });
  }
}

TEST(SpringForces, Balance) {
  const Net net = deformed_net(30);
  test::expect_balanced(forces_of(net), net.positions);
}

TEST(SpringForces, OfASpringWithoutLengthAreNone) {
  const std::vector<Point> rest{{0, 0, 0}, {2, 0, 0}};
  const Springs springs = springs_on_edges(band_graph(2), rest);
  const AlignedVector<double> collapsed{1, 1, 1, 0, 1, 1, 1, 0};
  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    AlignedVector<double> forces(8, 0.0);
    add_spring_forces(springs, kStiffness, collapsed, forces);
    EXPECT_EQ(forces, AlignedVector<double>(8, 0.0));
  });
}

TEST(SpringForces, RefusePositionsOfAnotherSize) {
  const Net net = deformed_net(4);
  AlignedVector<double> forces(12);
  EXPECT_THROW(add_spring_forces(net.springs, kStiffness, net.positions, forces), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
