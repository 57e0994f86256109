// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "elastic_system.hpp"
#include "lab/motion/loads.hpp"
#include "mesh/procedural.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(HeldVertices, LeaveTheirRowsAndColumnsEmptyButForTheDiagonal) {
  BlockCsr matrix = test::elastic_system(make_grid({.size = 2}), 1.0);
  Eigen::MatrixXd expected = test::dense(matrix);
  HeldVertices held;
  for (const Index v : {3, 17, 4}) {
    held.hold(v, Point{});
    const double mean = expected.block<3, 3>(3 * v, 3 * v).trace() / 3;
    expected.middleRows<3>(3 * v).setZero();
    expected.middleCols<3>(3 * v).setZero();
    expected.block<3, 3>(3 * v, 3 * v) = mean * Eigen::Matrix3d::Identity();
  }
  held.remove_from(matrix);
  EXPECT_LT((test::dense(matrix) - expected).norm(), 1e-14 * expected.norm());
}

TEST(HeldVertices, ADiagonalWithoutMassBecomesTheIdentity) {
  BlockCsr matrix;
  matrix.offsets = {0, 1};
  matrix.columns = {0};
  matrix.values.assign(9, 0.0);
  HeldVertices held;
  held.hold(0, Point{});
  held.remove_from(matrix);
  EXPECT_EQ(test::dense(matrix), Eigen::MatrixXd(Eigen::Matrix3d::Identity()));
}

TEST(HeldVertices, HaveTheLaterOfTwoVelocities) {
  HeldVertices held;
  held.hold(2, {1, 1, 1});
  held.hold(2, {5, 6, 7});
  std::vector<double> velocities(12, 9.0);
  held.set(velocities);
  EXPECT_EQ(velocities, (std::vector<double>{9, 9, 9, 9, 9, 9, 5, 6, 7, 9, 9, 9}));
  held.set_zero(velocities);
  EXPECT_EQ(velocities, (std::vector<double>{9, 9, 9, 9, 9, 9, 0, 0, 0, 9, 9, 9}));
}

TEST(HeldVertices, AreFreeWhenCleared) {
  HeldVertices held;
  held.hold(1, {1, 0, 0});
  held.clear();
  std::vector<double> velocities(9, 2.0);
  held.set(velocities);
  held.set_zero(velocities);
  EXPECT_EQ(velocities, std::vector<double>(9, 2.0));
}

}  // namespace
}  // namespace meshorder
