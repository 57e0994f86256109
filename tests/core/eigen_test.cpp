// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/refusal.hpp"
#include <meshorder/eigen.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace meshorder {
namespace {

using test::refusal;
using testing::HasSubstr;

/// Squares in a row: 2 (squares + 1) points, numbered along two lines, and a row of corners for each square.
struct Strip {
  static constexpr int kSquares = 6;
  Eigen::MatrixXd points{2 * (kSquares + 1), 3};
  Eigen::MatrixXi squares{kSquares, 4};

  Strip() {
    for (int i = 0; i <= kSquares; ++i) {
      points.row(i) << i, 0, 0;
      points.row(kSquares + 1 + i) << i, 1, 0;
    }
    for (int i = 0; i < kSquares; ++i) squares.row(i) << i, i + 1, kSquares + 2 + i, kSquares + 1 + i;
  }
};

TEST(Eigen, ReorderTakesTheShapeOfItsCells) {
  const Strip given;
  Strip moved = given;
  const MeshOrder order = reorder(moved.points, moved.squares, Shape::quad, {.vertices = "rcm"});
  const MeshOrder expected = order_mesh(given.points, given.squares, Shape::quad, {.vertices = "rcm"});
  EXPECT_EQ(order.vertices.permutation, expected.vertices.permutation);
  for (Index c = 0; c < Strip::kSquares; ++c) {
    for (int k = 0; k < 4; ++k) {
      const int old = given.squares(order.cells.permutation.new_to_old()[c], k);
      EXPECT_EQ(moved.points.row(moved.squares(c, k)), given.points.row(old));
    }
  }
  Eigen::MatrixXi bricks(1, 8);
  bricks << 0, 1, 8, 7, 2, 3, 10, 9;
  EXPECT_THAT(refusal([&] { (void)reorder(moved.points, bricks); }), HasSubstr("1 × 8 numbers"));
  EXPECT_EQ(reorder(moved.points, bricks, Shape::hexahedron).cells.permutation.size(), 1);
}

TEST(Eigen, FourColumnsAreQuadsInThePlane) {
  const Strip strip;
  const Eigen::MatrixXd plane = strip.points.leftCols(2);
  const MeshMethods by_facets{.vertices = "original", .elements = "fiedler-facet"};
  // each quad of a row shares an edge with the next; tetrahedra with these corners would share no face
  EXPECT_EQ(order_mesh(plane, strip.squares, by_facets).cells.fiedler.size(), 1U);
  EXPECT_EQ(order_mesh(strip.points, strip.squares, by_facets).cells.fiedler.size(), 6U);
  EXPECT_EQ(order_mesh(strip.points, strip.squares, Shape::quad, by_facets).cells.fiedler.size(), 1U);
}

TEST(Eigen, EmptyBracesAreNoShape) {
  const Strip strip;
  EXPECT_EQ(order_mesh(strip.points, strip.squares, {}, {.seed = 1}).cells.permutation.size(),
            Strip::kSquares);
}

TEST(Eigen, OrdersTheRowsOfEdges) {
  Eigen::MatrixXi edges(5, 2);
  edges << 3, 4, 0, 4, 2, 1, 1, 0, 3, 2;
  const Permutation vertices = Permutation::from_old_to_new({2, 0, 4, 1, 3});
  std::vector<int> ends;
  for (int e = 0; e < 5; ++e) ends.insert(ends.end(), {edges(e, 0), edges(e, 1)});
  const Permutation order = order_edges(edges, vertices);
  EXPECT_EQ(order, order_edges(ends, vertices));
  EXPECT_EQ(
      order_edges(Eigen::Matrix<std::int64_t, 5, 2, Eigen::RowMajor>(edges.cast<std::int64_t>()), vertices),
      order);
  EXPECT_THAT(refusal([&] { (void)order_edges(edges.transpose(), vertices); }),
              HasSubstr("a row for each edge"));
}

TEST(Eigen, SaysThatThereAreNoCells) {
  Strip strip;
  strip.squares.resize(0, 0);
  EXPECT_EQ(refusal([&] { (void)reorder(strip.points, strip.squares); }), "cells: F is empty");
  EXPECT_EQ(refusal([] { (void)points_view(Eigen::MatrixXd()); }), "points: V is empty");
}

}  // namespace
}  // namespace meshorder
