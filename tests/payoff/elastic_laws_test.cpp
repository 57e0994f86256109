// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "payoff/elastic.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <limits>

namespace meshorder {
namespace {

using test::Case;
using test::elasticity_of;
using test::forces_of;

class ElasticLaw : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(OfAll, ElasticLaw,
                         testing::Values(Case{MaterialModel::corotational, Tangent::exact},
                                         Case{MaterialModel::corotational, Tangent::approximate},
                                         Case{MaterialModel::corotational, Tangent::projected},
                                         Case{MaterialModel::stvk, Tangent::exact},
                                         Case{MaterialModel::stvk, Tangent::projected},
                                         Case{MaterialModel::stvk, Tangent::exact, 2},
                                         Case{MaterialModel::stvk, Tangent::exact, 1},
                                         Case{MaterialModel::neo_hookean, Tangent::exact},
                                         Case{MaterialModel::neo_hookean, Tangent::projected}),
                         test::case_name);

/// Positions of a row of simplices in ordinary states, some of them collapsed.
AlignedVector<double> with_collapsed_elements(const test::Patch& patch) {
  AlignedVector<double> x = patch.positions;
  for (std::size_t v = 10; v < patch.points.size(); v += 30) {
    for (std::size_t k = 1; k < 6 && v + k < patch.points.size(); ++k) {
      std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(kPaddedStride * v), 3,
                  x.begin() + static_cast<std::ptrdiff_t>(kPaddedStride * (v + k)));
    }
  }
  return x;
}

TEST_P(ElasticLaw, IsTheSameWithEveryInstructionSet) {
  for (const Index count : {1, 7, 8, 9, 101}) {
    const test::Patch patch = test::deformed_patch(GetParam().dimension, count);
    // the rotation of collapsed elements is arbitrary
    const bool any = GetParam().model != MaterialModel::corotational;
    const AlignedVector<double> x = any ? with_collapsed_elements(patch) : patch.positions;
    const Elasticity elasticity = elasticity_of(GetParam());
    AlignedVector<double> scalar(x.size(), 0.0);
    BlockCsr matrix = zero_block_csr(test::graph_of(patch));
    const AssemblyMap map = assembly_map(patch.rest, matrix);
    const Stiffness stiffness{map, matrix};
    add_elasticity_scalar(patch.rest, elasticity, x, scalar, &stiffness);
    EXPECT_GT(test::largest(scalar), 0.01);
    test::for_each_target([&](const char* target) {
      SCOPED_TRACE(target);
      test::expect_near(forces_of(patch, elasticity, x), scalar, 1e-12);
      test::expect_near(test::stiffness_of(patch, elasticity, x).values, matrix.values, 1e-11);
      EXPECT_NEAR(elastic_energy(patch.rest, elasticity, x), test::energy(patch, elasticity, x),
                  1e-12 * (1.0 + test::energy(patch, elasticity, x)));
    });
  }
}

TEST_P(ElasticLaw, HasNoForceAtRestHoweverTurned) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 21);
  const Elasticity elasticity = elasticity_of(GetParam());
  AlignedVector<double> x = test::mapped(patch.points, test::some_rotation(7));
  for (std::size_t i = 0; i < x.size(); i += kPaddedStride) x[i] += 3.0;
  EXPECT_NEAR(elastic_energy(patch.rest, elasticity, x), 0.0, 1e-13);
  EXPECT_LT(test::largest(forces_of(patch, elasticity, x)), 1e-12);
}

TEST_P(ElasticLaw, HasBalancedForces) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 21);
  test::expect_balanced(forces_of(patch, elasticity_of(GetParam()), patch.positions), patch.positions);
}

TEST_P(ElasticLaw, TurnsWithTheBody) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 21);
  const Elasticity elasticity = elasticity_of(GetParam());
  const Eigen::Matrix3d turn = test::some_rotation(9);
  const auto turned = [&](const AlignedVector<double>& v) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < v.size(); i += kPaddedStride) points.push_back({v[i], v[i + 1], v[i + 2]});
    return test::mapped(points, turn);
  };
  const AlignedVector<double> x = turned(patch.positions);
  EXPECT_NEAR(elastic_energy(patch.rest, elasticity, x),
              elastic_energy(patch.rest, elasticity, patch.positions), 1e-12);
  test::expect_near(forces_of(patch, elasticity, x), turned(forces_of(patch, elasticity, patch.positions)),
                    1e-12);
  const Eigen::MatrixXd stiffness = test::dense_stiffness(patch, elasticity, patch.positions);
  const Eigen::MatrixXd of_turned = test::dense_stiffness(patch, elasticity, x);
  const double scale = stiffness.cwiseAbs().maxCoeff();
  for (Eigen::Index a = 0; a < stiffness.rows(); a += 3) {
    for (Eigen::Index b = 0; b < stiffness.cols(); b += 3) {
      const Eigen::Matrix3d expected = turn * stiffness.block<3, 3>(a, b) * turn.transpose();
      ASSERT_LT((of_turned.block<3, 3>(a, b) - expected).cwiseAbs().maxCoeff(), 1e-10 * scale);
    }
  }
}

TEST_P(ElasticLaw, HasAFiniteSymmetricStiffnessThatDoesNotResistTranslation) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 19);
  const Elasticity elasticity = elasticity_of(GetParam());
  std::vector<AlignedVector<double>> positions{patch.positions, with_collapsed_elements(patch)};
  for (const test::State& state : test::states()) {
    positions.push_back(test::mapped(patch.points, test::gradient_of(state)));
  }
  for (const double tiny : {1e-7, 1e-100, 1e-160, 1e-310}) {
    positions.push_back(test::mapped(patch.points, tiny * test::gradient_of(test::states()[0])));
  }
  for (const AlignedVector<double>& x : positions) {
    for (const double force : forces_of(patch, elasticity, x)) ASSERT_TRUE(std::isfinite(force));
    const Eigen::MatrixXd stiffness = test::dense_stiffness(patch, elasticity, x);
    ASSERT_TRUE(stiffness.allFinite());
    EXPECT_EQ((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff(), 0.0);
    const double scale = stiffness.cwiseAbs().maxCoeff();
    for (int c = 0; c < 3; ++c) {
      Eigen::VectorXd translation = Eigen::VectorXd::Zero(stiffness.cols());
      for (Eigen::Index v = 0; v < translation.size(); v += 3) translation(v + c) = 1.0;
      EXPECT_LE((stiffness * translation).cwiseAbs().maxCoeff(), 1e-13 * scale);
    }
  }
}

TEST_P(ElasticLaw, EndsForPositionsThatAreNotFinite) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 9);
  const Elasticity elasticity = elasticity_of(GetParam());
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    AlignedVector<double> x = patch.positions;
    x[kPaddedStride + 1] = bad;
    EXPECT_FALSE(std::isfinite(elastic_energy(patch.rest, elasticity, x)));
    EXPECT_FALSE(std::isfinite(forces_of(patch, elasticity, x)[kPaddedStride + 1]));
  }
}

TEST_P(ElasticLaw, AddsToWhatIsThereToScale) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 9);
  const Elasticity elasticity = elasticity_of(GetParam());
  AlignedVector<double> forces = forces_of(patch, elasticity, patch.positions);
  AlignedVector<double> expected = forces;
  for (double& force : expected) force *= 2.0;
  BlockCsr matrix = test::stiffness_of(patch, elasticity, patch.positions);
  const Eigen::MatrixXd once = test::dense(matrix);
  const AssemblyMap map = assembly_map(patch.rest, matrix);
  const Stiffness stiffness{map, matrix, 0.25};
  add_elasticity(patch.rest, elasticity, patch.positions, forces, &stiffness);
  test::expect_near(forces, expected, 1e-13);
  EXPECT_LT((test::dense(matrix) - 1.25 * once).cwiseAbs().maxCoeff(), 1e-12 * once.cwiseAbs().maxCoeff());
}

TEST_P(ElasticLaw, TakesParametersOfEachSimplex) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 21);
  Elasticity elasticity = elasticity_of(GetParam());
  const AlignedVector<double> forces = forces_of(patch, elasticity, patch.positions);
  elasticity.mu.assign(24, test::kSteel.mu);
  elasticity.lambda.assign(24, test::kSteel.lambda);
  elasticity.lame = {};
  EXPECT_EQ(forces_of(patch, elasticity, patch.positions), forces);
  // the forces of two groups of simplices add up to those of all
  Elasticity others = elasticity;
  for (std::size_t s = 0; s < 24; ++s) {
    Elasticity& without = s % 3 == 0 ? elasticity : others;
    without.mu[s] = without.lambda[s] = 0.0;
  }
  AlignedVector<double> sum = forces_of(patch, elasticity, patch.positions);
  add_elasticity(patch.rest, others, patch.positions, sum, nullptr);
  test::expect_near(sum, forces, 1e-13);
}

class ElasticLawOfSolids : public ElasticLaw {};
INSTANTIATE_TEST_SUITE_P(OfAll, ElasticLawOfSolids,
                         testing::Values(Case{MaterialModel::corotational, Tangent::exact},
                                         Case{MaterialModel::corotational, Tangent::approximate},
                                         Case{MaterialModel::corotational, Tangent::projected},
                                         Case{MaterialModel::stvk, Tangent::exact},
                                         Case{MaterialModel::stvk, Tangent::projected},
                                         Case{MaterialModel::neo_hookean, Tangent::exact},
                                         Case{MaterialModel::neo_hookean, Tangent::projected}),
                         test::case_name);

/// The stiffness of linear elasticity, from its definition: K = Σ V Bᵀ C B column by column.
Eigen::MatrixXd linear_stiffness(const test::Patch& patch) {
  const auto n = static_cast<Eigen::Index>(3 * patch.points.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Offset s = 0; s < patch.simplices.size(); ++s) {
    const Index* const corner = patch.simplices.vertices.data() + 4 * s;
    Eigen::Matrix4d barycentric;
    for (int a = 0; a < 4; ++a) {
      const Point& p = patch.points[corner[a]];
      barycentric.row(a) << 1.0, p[0], p[1], p[2];
    }
    const double volume = std::abs(barycentric.determinant()) / 6;
    const Eigen::Matrix<double, 3, 4> gradients = barycentric.inverse().bottomRows<3>();
    for (int b = 0; b < 4; ++b) {
      for (int k = 0; k < 3; ++k) {
        const Eigen::Matrix3d gradient = Eigen::Vector3d::Unit(k) * gradients.col(b).transpose();
        const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
        const Eigen::Matrix3d stress =
            2 * test::kSteel.mu * strain + test::kSteel.lambda * strain.trace() * Eigen::Matrix3d::Identity();
        for (int a = 0; a < 4; ++a) {
          result.block<3, 1>(3 * corner[a], 3 * corner[b] + k) += volume * stress * gradients.col(a);
        }
      }
    }
  }
  return result;
}

TEST_P(ElasticLawOfSolids, IsLinearElasticityNearRest) {
  const test::Patch patch = test::deformed_patch(3, 21);
  const Eigen::MatrixXd expected = linear_stiffness(patch);
  const Eigen::MatrixXd actual =
      test::dense_stiffness(patch, elasticity_of(GetParam()), padded_positions(patch.points));
  EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
}

TEST(ApproximateTangent, IsLinearElasticityTurned) {
  const test::Patch patch = test::deformed_patch(3, 21);
  const Eigen::MatrixXd linear = linear_stiffness(patch);
  const test::State state{"", {1.4, 0.8, 0.3}};
  const Eigen::Matrix3d u = test::some_rotation(3);
  const Eigen::Matrix3d turn = u * test::some_rotation(4).transpose();
  const Eigen::MatrixXd actual =
      test::dense_stiffness(patch, elasticity_of({MaterialModel::corotational, Tangent::approximate}),
                            test::mapped(patch.points, test::gradient_of(state, 3)));
  for (Eigen::Index a = 0; a < linear.rows(); a += 3) {
    for (Eigen::Index b = 0; b < linear.cols(); b += 3) {
      const Eigen::Matrix3d expected = turn * linear.block<3, 3>(a, b) * turn.transpose();
      ASSERT_LT((actual.block<3, 3>(a, b) - expected).cwiseAbs().maxCoeff(),
                1e-12 * linear.cwiseAbs().maxCoeff());
    }
  }
}

TEST_P(ElasticLawOfSolids, PassesThePatchTest) {
  const Mesh grid = make_grid({.size = 4});
  const RestShapes rest = rest_shapes(cut_into_simplices(grid), grid.points);
  const CsrGraph graph = vertex_graph(grid);
  Eigen::Matrix3d stretch;
  stretch << 1.2, 0.3, -0.1, 0.0, 0.8, 0.2, 0.1, -0.2, 1.1;
  const AlignedVector<double> x = test::mapped(grid.points, stretch);
  AlignedVector<double> forces(x.size(), 0.0);
  add_elasticity(rest, elasticity_of(GetParam()), x, forces, nullptr);
  double largest_inside = 0.0;
  Index inside = 0;
  for (Index v = 0; v < grid.vertex_count(); ++v) {
    bool interior = true;
    for (const double c : grid.points[v]) interior = interior && c > 0.01 && c < 0.99;
    inside += interior ? 1 : 0;
    for (int c = 0; c < 3 && interior; ++c) {
      largest_inside = std::max(largest_inside, std::abs(forces[kPaddedStride * v + c]));
    }
  }
  EXPECT_EQ(inside, 27);
  EXPECT_LT(largest_inside, 1e-13);
  EXPECT_GT(test::largest(forces), 0.01);
}

TEST(ElasticEnergy, HasTheSameBitsOnOneThread) {
  const test::Patch patch = test::deformed_patch(3, 20000);
  for (const MaterialModel model :
       {MaterialModel::corotational, MaterialModel::stvk, MaterialModel::neo_hookean}) {
    const Elasticity elasticity = elasticity_of({model, Tangent::exact});
    const double on_all = elastic_energy(patch.rest, elasticity, patch.positions);
    tbb::task_arena alone(1);
    const double on_one =
        alone.execute([&] { return elastic_energy(patch.rest, elasticity, patch.positions); });
    EXPECT_EQ(on_one, on_all);
    EXPECT_GT(on_one, 1.0);
  }
}

TEST(ElasticLaws, AreForTetrahedraButForStVenantKirchhoff) {
  for (const int dimension : {1, 2}) {
    const test::Patch patch = test::deformed_patch(dimension, 3);
    for (const MaterialModel model : {MaterialModel::corotational, MaterialModel::neo_hookean}) {
      const Elasticity elasticity = elasticity_of({model, Tangent::exact});
      EXPECT_THROW(forces_of(patch, elasticity, patch.positions), InvalidArgument);
      EXPECT_THROW(elastic_energy(patch.rest, elasticity, patch.positions), InvalidArgument);
    }
    EXPECT_THROW(
        test::stiffness_of(patch, elasticity_of({MaterialModel::stvk, Tangent::projected}), patch.positions),
        InvalidArgument);
  }
}

TEST(ElasticLaws, RefuseWhatDoesNotFit) {
  const test::Patch patch = test::deformed_patch(3, 9);
  AlignedVector<double> forces(patch.positions.size() - 4);
  EXPECT_THROW(add_elasticity(patch.rest, {}, patch.positions, forces, nullptr), InvalidArgument);
  for (const MaterialModel model : {MaterialModel::stvk, MaterialModel::neo_hookean}) {
    EXPECT_THROW(test::stiffness_of(patch, elasticity_of({model, Tangent::approximate}), patch.positions),
                 InvalidArgument);
  }
  Elasticity elasticity;
  elasticity.mu.assign(9, 1.0);
  elasticity.lambda.assign(9, 1.0);
  EXPECT_THROW(forces_of(patch, elasticity, patch.positions), InvalidArgument);
  elasticity.mu.assign(16, 1.0);
  EXPECT_THROW(forces_of(patch, elasticity, patch.positions), InvalidArgument);
  BlockCsr matrix = zero_block_csr(test::graph_of(patch));
  const AssemblyMap none;
  const Stiffness stiffness{none, matrix};
  EXPECT_THROW(add_elasticity(patch.rest, {}, patch.positions, {}, &stiffness), InvalidArgument);
}

TEST(ElasticLaws, HaveNoForcesOnFlatSimplices) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0}};
  const RestShapes rest = rest_shapes(Simplices{3, {0, 1, 2, 3, 0, 1, 1, 2}, {}}, points);
  const AlignedVector<double> x =
      padded_positions(std::vector<Point>{{0, 0, 0}, {2, 0, 0}, {0, 1, 1}, {1, 5, 0}});
  for (const MaterialModel model :
       {MaterialModel::corotational, MaterialModel::stvk, MaterialModel::neo_hookean}) {
    AlignedVector<double> forces(16, 0.0);
    add_elasticity(rest, elasticity_of({model, Tangent::exact}), x, forces, nullptr);
    EXPECT_EQ(test::largest(forces), 0.0);
    EXPECT_EQ(elastic_energy(rest, elasticity_of({model, Tangent::exact}), x), 0.0);
  }
}

}  // namespace
}  // namespace meshorder
