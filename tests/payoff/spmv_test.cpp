// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/random.hpp"
#include "kernels/block_csr.hpp"
#include "payoff/deformed.hpp"
#include <meshorder/error.hpp>

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

template <class Value>
void expect_dense_product(const BlockCsrOf<Value>& matrix) {
  const auto n = 3 * static_cast<std::size_t>(matrix.size());
  // allocated at their exact size, so that a sanitizer detects reads past the end
  std::vector<double> x(n);
  Random random(6);
  for (double& value : x) value = random.unit() - 0.5;
  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    std::vector<double> y(n, 1e9);
    multiply(matrix, x, y);
    double expected_dot = 0.0;
    for (Index row = 0; row < 3 * matrix.size(); ++row) {
      double expected = 0.0;
      for (Index column = 0; column < 3 * matrix.size(); ++column) {
        const Offset block = matrix.find(row / 3, column / 3);
        if (block >= 0) expected += matrix.values[9 * block + 3 * (row % 3) + column % 3] * x[column];
      }
      EXPECT_NEAR(y[row], expected, 1e-14);
      expected_dot += x[row] * expected;
    }
    std::vector<double> by_parts(n, 1e9);
    double dot = 0.0;
    for (const auto& [begin, end] : {std::pair{0, 3}, {3, 3}, {3, matrix.size()}}) {
      dot += multiply_rows_dot(matrix, x, by_parts, begin, end);
    }
    EXPECT_EQ(by_parts, y);
    EXPECT_NEAR(dot, expected_dot, 1e-13);
  });
}

TEST(Multiply, EqualsTheDenseProductWithEveryInstructionSet) { expect_dense_product(some_matrix()); }

TEST(Multiply, EqualsTheDenseProductInSinglePrecision) {
  BlockCsrOf<float> rounded;
  round_to_single(some_matrix(), rounded);
  expect_dense_product(rounded);
}

TEST(Multiply, EqualsTheScalarProductWhereEntriesAreAskedForEarly) {
  // more vertices than a cache near the processor holds, in a cycle with random chords
  const Index n = 70'000;
  std::vector<Edge> edges;
  Random random(8);
  for (Index v = 0; v < n; ++v) {
    edges.push_back({v, (v + 1) % n});
    edges.push_back({v, static_cast<Index>(random.below(static_cast<std::uint64_t>(n)))});
  }
  BlockCsr matrix = zero_block_csr(graph_from_edges(n, edges));
  for (double& value : matrix.values) value = random.unit() - 0.5;
  std::vector<double> x(3 * static_cast<std::size_t>(n));
  for (double& value : x) value = random.unit() - 0.5;
  std::vector<double> y(x.size());
  multiply(matrix, x, y);
  for (Index v = 0; v < n; ++v) {
    double expected[3] = {};
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
      for (Index i = 0; i < 9; ++i) {
        expected[i / 3] += matrix.values[9 * k + i] * x[3 * matrix.columns[k] + i % 3];
      }
    }
    for (Index c = 0; c < 3; ++c) ASSERT_NEAR(y[3 * v + c], expected[c], 1e-14) << v;
  }
}

TEST(BlockCsr, IsRoundedToSinglePrecisionWithoutItsSpareBlocks) {
  BlockCsr matrix = some_matrix();
  BlockCsrOf<float> rounded;
  rounded.values.assign(1000, 5.0F);
  matrix.values.resize(matrix.values.size() + 18, 7.0);
  round_to_single(matrix, rounded);
  EXPECT_EQ(rounded.offsets, matrix.offsets);
  EXPECT_EQ(rounded.columns, matrix.columns);
  ASSERT_EQ(rounded.values.size(), 9 * matrix.columns.size());
  for (std::size_t i = 0; i < rounded.values.size(); ++i) {
    EXPECT_EQ(rounded.values[i], static_cast<float>(matrix.values[i]));
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
