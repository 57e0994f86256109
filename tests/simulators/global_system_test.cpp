// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/admm/global_system.hpp"

#include "base/random.hpp"
#include "kernels/positions.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <vector>

namespace meshorder {
namespace {

constexpr Index kVertices = 7;
constexpr double kSquaredStep = 0.25;

/// The stiffness of springs around a circle that join each vertex to two on either side.
SparseMatrix stiffness() {
  SparseMatrix matrix;
  for (Index v = 0; v < kVertices; ++v) {
    for (Index column = 0; column < kVertices; ++column) {
      const Index apart = (column - v + kVertices) % kVertices;
      const bool tied = apart == 1 || apart == 2 || apart == kVertices - 1 || apart == kVertices - 2;
      if (!tied && apart != 0) continue;
      matrix.columns.push_back(column);
      matrix.values.push_back(tied ? -3.0 : 12.0);
    }
    matrix.offsets.push_back(static_cast<Offset>(matrix.columns.size()));
  }
  return matrix;
}

std::vector<double> masses() {
  std::vector<double> result;
  for (Index v = 0; v < kVertices; ++v) result.push_back(1.0 + v);
  return result;
}

Eigen::MatrixXd dense(const SparseMatrix& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  for (Index row = 0; row < matrix.size(); ++row) {
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
      result(row, matrix.columns[k]) = matrix.values[k];
  }
  return result;
}

AlignedVector<double> random_vector(std::uint64_t seed) {
  AlignedVector<double> result = padded_zeros(kVertices);
  Random random(seed);
  for (Index v = 0; v < kVertices; ++v) {
    for (int c = 0; c < 3; ++c) result[Offset{4} * v + c] = 2 * random.unit() - 1;
  }
  return result;
}

TEST(GlobalSystem, IsTheMassesAndTheStiffness) {
  GlobalSystem<double> system(stiffness(), masses(), kSquaredStep);
  EXPECT_TRUE(system.hold({}));
  Eigen::MatrixXd expected = kSquaredStep * dense(stiffness());
  for (Index v = 0; v < kVertices; ++v) expected(v, v) += 1.0 + v;
  EXPECT_EQ(dense(system.matrix()), expected);
}

TEST(GlobalSystem, SolvesForTheOthersWhereVerticesAreHeld) {
  GlobalSystem<double> system(stiffness(), masses(), kSquaredStep);
  HeldVertices held;
  held.hold(5, {});
  held.hold(1, {1, 0, 0});
  held.hold(5, {0, 1, 0});  // held twice
  ASSERT_TRUE(system.hold(held));
  EXPECT_TRUE(system.is_held(1));
  EXPECT_FALSE(system.is_held(2));
  const AlignedVector<double> places = random_vector(1);
  AlignedVector<double> b = random_vector(2);
  const AlignedVector<double> loads = b;
  AlignedVector<double> x = places;
  system.apply_held(x, b);
  system.factor().solve(b, x);

  Eigen::MatrixXd whole = kSquaredStep * dense(stiffness());
  for (Index v = 0; v < kVertices; ++v) whole(v, v) += 1.0 + v;
  for (int c = 0; c < 3; ++c) {
    for (Index v = 0; v < kVertices; ++v) {
      if (v == 1 || v == 5) {
        EXPECT_DOUBLE_EQ(x[Offset{4} * v + c], places[Offset{4} * v + c]);
        continue;
      }
      // the vertex's equation of the whole system is satisfied
      double sum = 0.0;
      for (Index w = 0; w < kVertices; ++w) sum += whole(v, w) * x[Offset{4} * w + c];
      EXPECT_NEAR(sum, loads[Offset{4} * v + c], 1e-12);
    }
  }
}

TEST(GlobalSystem, FactorsAnewWhenOthersAreHeld) {
  GlobalSystem<double> system(stiffness(), masses(), kSquaredStep);
  HeldVertices held;
  EXPECT_TRUE(system.hold(held));
  EXPECT_FALSE(system.hold(held));
  held.hold(3, {});
  EXPECT_TRUE(system.hold(held));
  held.clear();
  held.hold(3, {4, 5, 6});  // the same vertices with other velocities
  EXPECT_FALSE(system.hold(held));
  held.hold(0, {});
  EXPECT_TRUE(system.hold(held));
  EXPECT_TRUE(system.is_held(0));
  held.clear();
  EXPECT_TRUE(system.hold(held));
  EXPECT_FALSE(system.is_held(3));
}

TEST(GlobalSystem, AVertexOfNoElementMayBeHeld) {
  SparseMatrix lonely;
  lonely.offsets = {0, 1, 2};
  lonely.columns = {0, 1};
  lonely.values = {0.0, 0.0};
  GlobalSystem<float> system(lonely, std::vector{2.0, 0.0}, 1.0);
  HeldVertices held;
  held.hold(1, {});
  ASSERT_TRUE(system.hold(held));
  AlignedVector<float> b{4, 6, 8, 0, 9, 9, 9, 0};
  AlignedVector<float> x{0, 0, 0, 0, 1, 2, 3, 0};
  system.apply_held(x, b);
  system.factor().solve(b, x);
  EXPECT_EQ(x, (AlignedVector<float>{2, 3, 4, 0, 1, 2, 3, 0}));
}

}  // namespace
}  // namespace meshorder
