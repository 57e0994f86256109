// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/refusal.hpp"
#include <meshorder/eigen.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(Eigen, SaysThatThereAreNoCells) {
  Strip strip;
  strip.squares.resize(0, 0);
  EXPECT_EQ(refusal([&] { (void)reorder(strip.points, strip.squares); }), "cells: F is empty");
}

}  // namespace
}  // namespace meshorder
