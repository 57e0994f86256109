// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/elastic.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

using test::Case;

/// One tetrahedron whose edges at rest are the unit vectors of the axes. Its shape gradients are orthonormal,
/// and the stiffness of its corners 1, 2 and 3 is ∂²Ψ/∂F∂F times its volume, in the frame of the axes.
test::Patch unit_tetrahedron() {
  test::Patch patch;
  patch.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  patch.simplices = {3, {0, 1, 2, 3}, {}};
  patch.rest = rest_shapes(patch.simplices, patch.points);
  return patch;
}

Eigen::MatrixXd hessian(const Case& law, const Eigen::Matrix3d& f) {
  const test::Patch patch = unit_tetrahedron();
  return test::dense_stiffness(patch, test::elasticity_of(law), test::mapped(patch.points, f))
      .bottomRightCorner(9, 9);
}

Eigen::MatrixXd semidefinite_part(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
         solver.eigenvectors().transpose();
}

class Projection : public testing::TestWithParam<MaterialModel> {};
INSTANTIATE_TEST_SUITE_P(OfAll, Projection,
                         testing::Values(MaterialModel::corotational, MaterialModel::stvk,
                                         MaterialModel::neo_hookean));

TEST_P(Projection, IsTheSemidefinitePartOfTheHessian) {
  Random random(11);
  std::vector<test::State> states = test::states();
  for (int i = 0; i < 200; ++i) {
    states.push_back({"random", {2 * random.unit(), random.unit(), 0.9 * (random.unit() - random.unit())}});
  }
  int indefinite = 0;
  for (const test::State& state : states) {
    if (GetParam() == MaterialModel::corotational && !state.smooth) continue;
    SCOPED_TRACE(state.name);
    const Eigen::Matrix3d f = test::gradient_of(state, random.below(1000));
    const Eigen::MatrixXd exact = hessian({GetParam(), Tangent::exact}, f);
    const Eigen::MatrixXd projected = hessian({GetParam(), Tangent::projected}, f);
    const double scale = 1.0 + exact.cwiseAbs().maxCoeff();
    EXPECT_LT((projected - semidefinite_part(exact)).cwiseAbs().maxCoeff(), 1e-11 * scale) << f;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(exact, Eigen::EigenvaluesOnly);
    indefinite += eigen.eigenvalues()(0) < -1e-3 * scale;
  }
  EXPECT_GT(indefinite, 20);
}

TEST_P(Projection, IsSemidefiniteAndFiniteWhereTheHessianIsNot) {
  const test::Patch patch = test::deformed_patch(3, 19);
  const Elasticity elasticity = test::elasticity_of({GetParam(), Tangent::projected});
  for (const test::State& state : test::states()) {
    SCOPED_TRACE(state.name);
    const AlignedVector<double> x = test::mapped(patch.points, test::gradient_of(state));
    const Eigen::MatrixXd stiffness = test::dense_stiffness(patch, elasticity, x);
    ASSERT_TRUE(stiffness.allFinite());
    EXPECT_EQ((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff(), 0.0);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues();
    EXPECT_GT(values.minCoeff(), -1e-12 * (1.0 + values.maxCoeff()));
  }
}

}  // namespace
}  // namespace meshorder
