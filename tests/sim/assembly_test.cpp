// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/graph/incidence.hpp>
#include <meshorder/sim/kernels/assembly.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <sim/deformed.hpp>

namespace meshorder {
namespace {

CsrGraph graph_of(const test::Patch& patch) {
  Incidence elements;
  elements.vertex_count = index_size(patch.points);
  elements.vertices = patch.simplices.vertices;
  for (Offset s = 1; s <= patch.simplices.size(); ++s) {
    elements.offsets.push_back(s * (patch.simplices.dimension + 1));
  }
  return vertex_graph(elements);
}

BlockCsr stiffness_of(const test::Patch& patch, const AlignedVector<double>& positions) {
  BlockCsr matrix = zero_block_csr(graph_of(patch));
  add_stvk_stiffness(patch.rest, test::kSteel, positions, assembly_map(patch.rest, matrix), matrix);
  return matrix;
}

Eigen::MatrixXd dense(const BlockCsr& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * matrix.size(), 3 * matrix.size());
  for (Index row = 0; row < matrix.size(); ++row) {
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
      for (int i = 0; i < 9; ++i) {
        result(3 * row + i / 3, 3 * matrix.columns[k] + i % 3) = matrix.values[9 * k + i];
      }
    }
  }
  return result;
}

Eigen::MatrixXd edges(const Index* corner, int d, const std::vector<Point>& points) {
  Eigen::MatrixXd result(3, d);
  for (int a = 0; a < d; ++a) {
    for (int c = 0; c < 3; ++c) result(c, a) = points[corner[a + 1]][c] - points[corner[0]][c];
  }
  return result;
}

/// The Hessian column by column, from the variation of the stress in each coordinate of each corner, in
/// another frame of rest than the kernel's.
Eigen::MatrixXd dense_stiffness(const test::Patch& patch) {
  const int d = patch.simplices.dimension;
  std::vector<Point> deformed(patch.points.size());
  for (std::size_t v = 0; v < deformed.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) deformed[v][c] = patch.positions[kPaddedStride * v + c];
  }
  const auto n = static_cast<Eigen::Index>(3 * deformed.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Offset s = 0; s < patch.simplices.size(); ++s) {
    const Index* const corner = patch.simplices.vertices.data() + (d + 1) * s;
    const Eigen::MatrixXd rest = edges(corner, d, patch.points);
    const Eigen::MatrixXd metric = rest.transpose() * rest;
    // a square root of the metric is the edge matrix in some orthonormal frame
    const Eigen::MatrixXd inverse =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(metric).operatorInverseSqrt();
    const double volume = std::sqrt(metric.determinant()) / (d == 3 ? 6 : d);
    const Eigen::MatrixXd f = edges(corner, d, deformed) * inverse;
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(d, d);
    const auto stress = [&](const Eigen::MatrixXd& strain) -> Eigen::MatrixXd {
      return 2 * test::kSteel.mu * strain + test::kSteel.lambda * strain.trace() * identity;
    };
    Eigen::MatrixXd g(d + 1, d);
    g << -inverse.colwise().sum(), inverse;
    for (int b = 0; b <= d; ++b) {
      for (int k = 0; k < 3; ++k) {
        const Eigen::MatrixXd df = Eigen::Vector3d::Unit(k) * g.row(b);
        const Eigen::MatrixXd dp = df * stress(0.5 * (f.transpose() * f - identity)) +
                                   f * stress(0.5 * (df.transpose() * f + f.transpose() * df));
        for (int a = 0; a <= d; ++a) {
          result.block<3, 1>(3 * corner[a], 3 * corner[b] + k) += volume * dp * g.row(a).transpose();
        }
      }
    }
  }
  return result;
}

class StvkStiffness : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OfBarsMembranesSolids, StvkStiffness, testing::Values(1, 2, 3));

TEST_P(StvkStiffness, EqualsTheDenseOneWithEveryInstructionSet) {
  for (const Index count : {1, 8, 19}) {
    const test::Patch patch = test::deformed_patch(GetParam(), count);
    const Eigen::MatrixXd expected = dense_stiffness(patch);
    test::for_each_target([&](const char* target) {
      SCOPED_TRACE(target);
      const Eigen::MatrixXd actual = dense(stiffness_of(patch, patch.positions));
      EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
    });
  }
}

TEST_P(StvkStiffness, IsTheDerivativeOfTheForces) {
  const test::Patch patch = test::deformed_patch(GetParam(), 19);
  const Eigen::MatrixXd stiffness = dense(stiffness_of(patch, patch.positions));
  AlignedVector<double> x = patch.positions;
  constexpr double kStep = 1e-5;
  for (Index column = 0; column < stiffness.cols(); ++column) {
    const Index entry = kPaddedStride * (column / 3) + column % 3;
    AlignedVector<double> above(x.size(), 0.0);
    AlignedVector<double> below(x.size(), 0.0);
    x[entry] = patch.positions[entry] + kStep;
    add_stvk_forces_scalar(patch.rest, test::kSteel, x, above);
    x[entry] = patch.positions[entry] - kStep;
    add_stvk_forces_scalar(patch.rest, test::kSteel, x, below);
    x[entry] = patch.positions[entry];
    for (Index row = 0; row < stiffness.rows(); ++row) {
      const Index place = kPaddedStride * (row / 3) + row % 3;
      ASSERT_NEAR(stiffness(row, column), (below[place] - above[place]) / (2 * kStep),
                  1e-8 * stiffness.cwiseAbs().maxCoeff());
    }
  }
}

TEST_P(StvkStiffness, IsSymmetricAndDoesNotResistTranslation) {
  const test::Patch patch = test::deformed_patch(GetParam(), 19);
  const Eigen::MatrixXd stiffness = dense(stiffness_of(patch, patch.positions));
  const double scale = stiffness.cwiseAbs().maxCoeff();
  EXPECT_LT((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff(), 1e-14 * scale);
  for (int c = 0; c < 3; ++c) {
    Eigen::VectorXd translation = Eigen::VectorXd::Zero(stiffness.cols());
    for (Eigen::Index v = 0; v < translation.size(); v += 3) translation(v + c) = 1.0;
    EXPECT_LT((stiffness * translation).cwiseAbs().maxCoeff(), 1e-13 * scale);
  }
}

TEST_P(StvkStiffness, IsPositiveSemidefiniteAtRest) {
  const test::Patch patch = test::deformed_patch(GetParam(), 19);
  const Eigen::MatrixXd stiffness = dense(stiffness_of(patch, padded_positions(patch.points)));
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
}

TEST_P(StvkStiffness, AddsToWhatIsThere) {
  const test::Patch patch = test::deformed_patch(GetParam(), 9);
  BlockCsr matrix = stiffness_of(patch, patch.positions);
  const Eigen::MatrixXd once = dense(matrix);
  const AssemblyMap map = assembly_map(patch.rest, matrix);
  add_stvk_stiffness(patch.rest, test::kSteel, patch.positions, map, matrix);
  EXPECT_LT((dense(matrix) - 2 * once).cwiseAbs().maxCoeff(), 1e-13 * once.cwiseAbs().maxCoeff());
}

TEST(AssemblyMap, RefusesAMatrixWithoutTheBlocks) {
  const test::Patch patch = test::deformed_patch(3, 9);
  BlockCsr diagonal = zero_block_csr(graph_from_edges(12, {}));
  EXPECT_THROW(assembly_map(patch.rest, diagonal), InvalidArgument);
  EXPECT_THROW(add_stvk_stiffness(patch.rest, test::kSteel, patch.positions, {}, diagonal), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
