// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/base/random.hpp>
#include <meshorder/sim/kernels/spmv.hpp>

#include <gtest/gtest.h>

namespace meshorder {
namespace {

CsrGraph some_graph() {
  const std::vector<Edge> edges{{0, 3}, {3, 1}, {1, 0}, {4, 3}, {5, 0}};
  return graph_from_edges(7, edges);  // vertices 2 and 6 are isolated
}

BlockCsr some_matrix() {
  BlockCsr matrix = zero_block_csr(some_graph());
  Random random(5);
  for (double& value : matrix.values) value = random.unit() - 0.5;
  return matrix;
}

TEST(BlockCsr, HasABlockForEveryVertexAndBothDirectionsOfEveryEdge) {
  const CsrGraph graph = some_graph();
  const BlockCsr matrix = zero_block_csr(graph);
  ASSERT_EQ(matrix.size(), 7);
  EXPECT_EQ(matrix.block_count(), 7 + 2 * graph.edge_count());
  EXPECT_EQ(matrix.values, AlignedVector<double>(9 * matrix.columns.size(), 0.0));
  for (Index row = 0; row < 7; ++row) {
    for (Index column = 0; column < 7; ++column) {
      const bool edge = std::binary_search(graph[row].begin(), graph[row].end(), column);
      const Offset block = matrix.find(row, column);
      ASSERT_EQ(block >= 0, edge || row == column) << row << ' ' << column;
      if (block < 0) continue;
      EXPECT_EQ(matrix.columns[block], column);
      EXPECT_GE(block, matrix.offsets[row]);
      EXPECT_LT(block, matrix.offsets[row + 1]);
    }
  }
}

TEST(Multiply, EqualsTheDenseProduct) {
  const BlockCsr matrix = some_matrix();
  std::vector<double> x(21);
  Random random(6);
  for (double& value : x) value = random.unit() - 0.5;
  std::vector<double> y(21, 1e9);
  multiply(matrix, x, y);
  for (Index row = 0; row < 21; ++row) {
    double expected = 0.0;
    for (Index column = 0; column < 21; ++column) {
      const Offset block = matrix.find(row / 3, column / 3);
      if (block >= 0) expected += matrix.values[9 * block + 3 * (row % 3) + column % 3] * x[column];
    }
    EXPECT_NEAR(y[row], expected, 1e-14);
  }
}

TEST(Multiply, RefusesVectorsOfAnotherSize) {
  const BlockCsr matrix = some_matrix();
  std::vector<double> right(21);
  std::vector<double> wrong(20);
  EXPECT_THROW(multiply(matrix, wrong, right), InvalidArgument);
  EXPECT_THROW(multiply(matrix, right, wrong), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
