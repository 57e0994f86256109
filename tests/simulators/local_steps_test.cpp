// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/random.hpp"
#include "payoff/elastic.hpp"
#include "simulators/local_step.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace meshorder {
namespace {

constexpr double kScale = 0.3;

/// D of one element on all coordinates of the vertices, its weight w², and its shape.
struct DenseElement {
  Eigen::MatrixXd d;
  double weight = 0.0;
  Eigen::VectorXd rest;  ///< D X
};

/// The elements by their definition, springs in the order of springs_on_edges.
std::vector<DenseElement> dense_elements(const LocalLaw& law, const test::Patch& patch) {
  const auto n = static_cast<Eigen::Index>(patch.points.size());
  Eigen::VectorXd x(3 * n);
  for (Eigen::Index v = 0; v < n; ++v) {
    for (int c = 0; c < 3; ++c) x(3 * v + c) = patch.points[v][c];
  }
  std::vector<DenseElement> result;
  if (law.model == LocalModel::springs) {
    std::map<std::pair<Index, Index>, bool> edges;  // by the larger end and then the smaller
    for (Offset s = 0; s < patch.simplices.size(); ++s) {
      const Index* const corner = patch.simplices.vertices.data() + 4 * s;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          if (corner[a] < corner[b]) edges[{corner[b], corner[a]}] = true;
        }
      }
    }
    for (const auto& [edge, is] : edges) {
      DenseElement element{Eigen::MatrixXd::Zero(3, 3 * n), law.stiffness, {}};
      element.d.block<3, 3>(0, 3 * edge.second).setIdentity();
      element.d.block<3, 3>(0, 3 * edge.first) = -Eigen::Matrix3d::Identity();
      result.push_back(std::move(element));
    }
  } else {
    for (Offset s = 0; s < patch.simplices.size(); ++s) {
      const Index* const corner = patch.simplices.vertices.data() + 4 * s;
      Eigen::Matrix3d rest;
      for (int a = 0; a < 3; ++a) {
        rest.col(a) = x.segment<3>(3 * corner[a + 1]) - x.segment<3>(3 * corner[0]);
      }
      const Eigen::Matrix3d inverse = rest.inverse();
      DenseElement element{Eigen::MatrixXd::Zero(9, 3 * n), 0.0, {}};
      element.weight = test::weight_of(law) * std::abs(rest.determinant()) / 6;
      // rows 3 j + c: F's column j
      for (int j = 0; j < 3; ++j) {
        for (int a = 0; a < 3; ++a) {
          element.d.block<3, 3>(3 * j, 3 * corner[a + 1]).diagonal().array() += inverse(a, j);
          element.d.block<3, 3>(3 * j, 3 * corner[0]).diagonal().array() -= inverse(a, j);
        }
      }
      result.push_back(std::move(element));
    }
  }
  for (DenseElement& element : result) element.rest = element.d * x;
  return result;
}

Eigen::VectorXd unpadded(std::span<const double> x, Index n) {
  Eigen::VectorXd result(3 * n);
  for (Index v = 0; v < n; ++v) {
    for (int c = 0; c < 3; ++c) result(3 * v + c) = x[kPaddedStride * v + c];
  }
  return result;
}

/// z of one element: springs by their formula, tetrahedra by a kernel that other tests compare with brute
/// force.
Eigen::VectorXd step_of(const LocalLaw& law, const DenseElement& element, const Eigen::VectorXd& q) {
  if (law.model == LocalModel::springs) {
    return 0.5 * (q + element.rest.norm() * q.normalized());
  }
  const Eigen::Matrix3d f = Eigen::Map<const Eigen::Matrix3d>(q.data());
  const Eigen::Matrix3d z = test::local_steps<double>(law, {f}).front();
  return Eigen::Map<const Eigen::VectorXd>(z.data(), 9);
}

class LocalPasses : public testing::TestWithParam<LocalModel> {};

TEST_P(LocalPasses, AreThoseOfDenseMatrices) {
  const LocalLaw law = test::law_of(GetParam());
  for (const Index count : {1, 7, 8, 9, 40}) {
    SCOPED_TRACE(count);
    const test::Patch patch = test::tetrahedra(count);
    const auto n = index_size(patch.points);
    const std::vector<DenseElement> elements = dense_elements(law, patch);
    auto steps = test::steps_of(law, patch);
    ASSERT_EQ(steps.element_count(), static_cast<Offset>(elements.size()));
    std::vector<Eigen::VectorXd> duals;
    duals.reserve(elements.size());
    for (const DenseElement& element : elements) {
      duals.emplace_back(Eigen::VectorXd::Zero(element.d.rows()));
    }
    for (int pass = 0; pass < 4; ++pass) {
      const AlignedVector<double> x = test::shaken(patch, pass);
      AlignedVector<double> sums = test::sums_for(steps);
      const LocalResidual residual = steps.pass(x, kScale, sums);

      Eigen::VectorXd expected = Eigen::VectorXd::Zero(3 * n);
      LocalResidual expected_residual;
      for (std::size_t s = 0; s < elements.size(); ++s) {
        const auto& [d, weight, rest] = elements[s];
        const Eigen::VectorXd moved = d * unpadded(x, n);
        const Eigen::VectorXd q = moved + duals[s];
        const Eigen::VectorXd z = step_of(law, elements[s], q);
        duals[s] = q - z;
        expected += kScale * weight * d.transpose() * (z - duals[s]);
        expected_residual.primal += weight * (moved - z).squaredNorm();
        expected_residual.magnitude += weight * z.squaredNorm();
      }
      const double largest = expected.cwiseAbs().maxCoeff();
      EXPECT_LT((unpadded(sums, n) - expected).cwiseAbs().maxCoeff(), 1e-12 * largest);
      EXPECT_NEAR(residual.primal, expected_residual.primal, 1e-11 * expected_residual.magnitude);
      EXPECT_NEAR(residual.magnitude, expected_residual.magnitude, 1e-12 * expected_residual.magnitude);
      for (Index v = 0; v < n; ++v) EXPECT_EQ(sums[kPaddedStride * v + 3], 0.0);
    }
    const std::vector<double> actual = steps.duals();
    const Index rows = law.model == LocalModel::springs ? 3 : 9;
    ASSERT_EQ(actual.size(), rows * elements.size());
    for (std::size_t s = 0; s < elements.size(); ++s) {
      for (Index k = 0; k < rows; ++k) {
        // the kernel stores F by rows, this test by columns
        const Index from = rows == 9 ? k % 3 * 3 + k / 3 : k;
        EXPECT_NEAR(actual[rows * s + k], duals[s](from), 1e-12);
      }
    }
  }
}

TEST_P(LocalPasses, HaveTheStiffnessOfDenseMatrices) {
  const LocalLaw law = test::law_of(GetParam());
  const test::Patch patch = test::tetrahedra(20);
  const auto n = index_size(patch.points);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (const DenseElement& element : dense_elements(law, patch)) {
    expected += element.weight * element.d.transpose() * element.d;
  }
  const SparseMatrix matrix = test::steps_of(law, patch).stiffness();
  ASSERT_EQ(matrix.size(), n);
  Eigen::MatrixXd actual = Eigen::MatrixXd::Zero(n, n);
  for (Index row = 0; row < n; ++row) {
    bool has_diagonal = false;
    for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
      if (k > matrix.offsets[row]) {
        EXPECT_LT(matrix.columns[k - 1], matrix.columns[k]);
      }
      has_diagonal = has_diagonal || matrix.columns[k] == row;
      actual(row, matrix.columns[k]) = matrix.values[k];
    }
    EXPECT_TRUE(has_diagonal);
  }
  EXPECT_EQ(actual, actual.transpose());
  for (int c = 0; c < 3; ++c) {
    const Eigen::MatrixXd of_axis = expected(Eigen::seqN(c, n, 3), Eigen::seqN(c, n, 3));
    EXPECT_LT((actual - of_axis).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
  }
}

/// Residuals after a few passes.
struct Outcome {
  std::vector<double> sums;
  std::vector<double> duals;
  std::vector<double> residuals;
  bool operator==(const Outcome&) const = default;
};

template <class Real = double>
Outcome outcome(const LocalLaw& law, const test::Patch& patch, double amplitude) {
  LocalSteps<Real> steps = test::steps_of<Real>(law, patch);
  Outcome result;
  for (int pass = 0; pass < 3; ++pass) {
    const AlignedVector<double> x = test::shaken(patch, pass, amplitude);
    const AlignedVector<Real> positions(x.begin(), x.end());
    AlignedVector<Real> sums = test::sums_for(steps);
    const LocalResidual residual = steps.pass(positions, static_cast<Real>(kScale), sums);
    result.residuals.insert(result.residuals.end(), {residual.primal, residual.magnitude});
    result.sums.insert(result.sums.end(), sums.begin(),
                       sums.begin() + kPaddedStride * static_cast<std::ptrdiff_t>(patch.points.size()));
  }
  const std::vector<Real> duals = steps.duals();
  result.duals.assign(duals.begin(), duals.end());
  return result;
}

TEST_P(LocalPasses, AreTheSameForAnyNumberOfThreads) {
  const LocalLaw law = test::law_of(GetParam());
  for (const double amplitude : {0.2, 3.0}) {
    const test::Patch patch = test::tetrahedra(500);
    Outcome expected[2];
    for (const std::size_t threads : {1, 2, 3, 5}) {
      SCOPED_TRACE(threads);
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const Outcome actual[2] = {outcome<double>(law, patch, amplitude),
                                 outcome<float>(law, patch, amplitude)};
      for (int k = 0; k < 2; ++k) {
        if (threads == 1) expected[k] = actual[k];
        EXPECT_EQ(actual[k], expected[k]);
      }
    }
  }
}

TEST_P(LocalPasses, GoOnFromTheirDuals) {
  const LocalLaw law = test::law_of(GetParam());
  const test::Patch patch = test::tetrahedra(101);
  auto steps = test::steps_of(law, patch);
  AlignedVector<double> sums = test::sums_for(steps);
  steps.pass(test::shaken(patch, 0), kScale, sums);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 3);
  auto restored = test::steps_of(law, patch);
  AlignedVector<double> restored_sums = test::sums_for(restored);
  restored.set_duals(steps.duals());
  steps.pass(test::shaken(patch, 1), kScale, sums);
  restored.pass(test::shaken(patch, 1), kScale, restored_sums);
  const auto end = kPaddedStride * static_cast<std::ptrdiff_t>(patch.points.size());
  EXPECT_TRUE(std::equal(sums.begin(), sums.begin() + end, restored_sums.begin()));
  EXPECT_EQ(steps.duals(), restored.duals());

  restored.reset_duals();
  EXPECT_EQ(restored.duals(), std::vector<double>(steps.duals().size(), 0.0));
}

TEST_P(LocalPasses, AreTheSameToRoundingInAnyOrder) {
  const LocalLaw law = test::law_of(GetParam());
  const test::Patch patch = test::tetrahedra(60);
  const auto n = patch.points.size();
  test::Patch other;
  std::vector<Index> old_to_new(n);
  for (std::size_t v = 0; v < n; ++v) old_to_new[v] = static_cast<Index>((17 * v + 5) % n);
  other.points.resize(n);
  for (std::size_t v = 0; v < n; ++v) other.points[old_to_new[v]] = patch.points[v];
  other.simplices.dimension = 3;
  for (std::size_t s = 0; s < 60; ++s) {
    for (int a = 0; a < 4; ++a) {
      other.simplices.vertices.push_back(old_to_new[patch.simplices.vertices[4 * ((7 * s + 3) % 60) + a]]);
    }
  }
  const AlignedVector<double> x = test::shaken(patch, 0);
  AlignedVector<double> moved(x.size());
  for (std::size_t v = 0; v < n; ++v) {
    std::copy_n(x.begin() + kPaddedStride * static_cast<std::ptrdiff_t>(v), kPaddedStride,
                moved.begin() + Offset{kPaddedStride} * old_to_new[v]);
  }
  auto steps = test::steps_of(law, patch);
  auto steps_of_other = test::steps_of(law, other);
  AlignedVector<double> sums = test::sums_for(steps);
  AlignedVector<double> sums_of_other = test::sums_for(steps_of_other);
  const LocalResidual residual = steps.pass(x, kScale, sums);
  const LocalResidual residual_of_other = steps_of_other.pass(moved, kScale, sums_of_other);
  EXPECT_NEAR(residual.primal, residual_of_other.primal, 1e-11 * residual.magnitude);
  EXPECT_NEAR(residual.magnitude, residual_of_other.magnitude, 1e-12 * residual.magnitude);
  for (std::size_t v = 0; v < n; ++v) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(sums[kPaddedStride * v + c], sums_of_other[Offset{kPaddedStride} * old_to_new[v] + c],
                  1e-12 * test::largest(sums));
    }
  }
}

TEST_P(LocalPasses, OfFloatsAreThoseOfDoubles) {
  const LocalLaw law = test::law_of(GetParam());
  const test::Patch patch = test::tetrahedra(200);
  const Outcome expected = outcome<double>(law, patch, 0.1);
  const Outcome actual = outcome<float>(law, patch, 0.1);
  test::expect_near(actual.sums, expected.sums, 2e-5);
  // duals are differences of coordinates a thousand times as large
  test::expect_near(actual.duals, expected.duals, 3e-4);
  for (std::size_t i = 0; i < expected.residuals.size(); i += 2) {
    EXPECT_NEAR(actual.residuals[i], expected.residuals[i], 1e-5 * expected.residuals[i + 1]);
    EXPECT_NEAR(actual.residuals[i + 1], expected.residuals[i + 1], 1e-5 * expected.residuals[i + 1]);
  }
}

TEST_P(LocalPasses, AreTheSameWithEveryInstructionSet) {
  const LocalLaw law = test::law_of(GetParam());
  const test::Patch patch = test::tetrahedra(37);
  const Outcome expected = outcome(law, patch, 0.3);
  const Outcome expected_floats = outcome<float>(law, patch, 0.3);
  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    test::expect_near(outcome(law, patch, 0.3).sums, expected.sums, 1e-11);
    test::expect_near(outcome<float>(law, patch, 0.3).sums, expected_floats.sums, 1e-4);
  });
}

TEST_P(LocalPasses, LeaveABodyAtRest) {
  const LocalLaw law = test::law_of(GetParam());
  const test::Patch patch = test::tetrahedra(30);
  auto steps = test::steps_of(law, patch);
  AlignedVector<double> sums = test::sums_for(steps);
  const AlignedVector<double> x = padded_positions(patch.points);
  const LocalResidual residual = steps.pass(x, 1.0, sums);
  EXPECT_LT(residual.primal, 1e-24 * residual.magnitude);
  EXPECT_LT(test::largest(steps.duals()), 1e-12);
  EXPECT_NEAR(steps.energy(x), 0.0, 1e-14);
  // at rest Σ Dᵀw²z is the stiffness times the rest positions
  const SparseMatrix matrix = steps.stiffness();
  for (Index row = 0; row < matrix.size(); ++row) {
    for (int c = 0; c < 3; ++c) {
      double expected = 0.0;
      for (Offset k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k) {
        expected += matrix.values[k] * patch.points[matrix.columns[k]][c];
      }
      EXPECT_NEAR(sums[Offset{kPaddedStride} * row + c], expected, 1e-11 * test::largest(sums));
    }
  }
}

/// The body's vertices are all at one point.
TEST_P(LocalPasses, UnfoldWhatIsSquashedToAPoint) {
  const LocalLaw law = test::law_of(GetParam());
  if (law.model != LocalModel::springs && law.model != LocalModel::strain) return;
  const test::Patch patch = test::tetrahedra(25);
  auto steps = test::steps_of(law, patch);
  AlignedVector<double> at_point(kPaddedStride * patch.points.size(), 0.0);
  for (std::size_t i = 0; i < at_point.size(); i += kPaddedStride) at_point[i] = 0.25;
  AlignedVector<double> at_rest_sums = test::sums_for(steps);
  steps.pass(padded_positions(patch.points), 1.0, at_rest_sums);
  steps.reset_duals();
  AlignedVector<double> sums = test::sums_for(steps);
  const LocalResidual residual = steps.pass(at_point, 1.0, sums);
  EXPECT_GT(residual.primal, 0.0);
  // z − u has its value at rest: the identity, and the springs' rest edges
  const auto end = kPaddedStride * static_cast<std::ptrdiff_t>(patch.points.size());
  test::expect_near({sums.data(), static_cast<std::size_t>(end)},
                    {at_rest_sums.data(), static_cast<std::size_t>(end)}, 1e-13);
}

TEST_P(LocalPasses, DoWithoutFlatTetrahedra) {
  const LocalLaw law = test::law_of(GetParam());
  if (law.model == LocalModel::springs) return;
  const test::Patch patch = test::tetrahedra(20);
  test::Patch with_flat = patch;
  std::vector<Index>& vertices = with_flat.simplices.vertices;
  vertices.insert(vertices.begin(), {3, 3, 4, 5});
  vertices.insert(vertices.begin() + 40, {7, 8, 9, 7});
  vertices.insert(vertices.end(), {1, 2, 2, 3});
  auto steps = test::steps_of(law, patch);
  auto steps_with_flat = test::steps_of(law, with_flat);
  EXPECT_EQ(steps_with_flat.element_count(), 23);
  for (int pass = 0; pass < 3; ++pass) {
    const AlignedVector<double> x = test::shaken(patch, pass);
    AlignedVector<double> sums = test::sums_for(steps);
    AlignedVector<double> sums_with_flat = test::sums_for(steps_with_flat);
    const LocalResidual residual = steps.pass(x, 1.0, sums);
    const LocalResidual residual_with_flat = steps_with_flat.pass(x, 1.0, sums_with_flat);
    EXPECT_NEAR(residual.magnitude, residual_with_flat.magnitude, 1e-12 * residual.magnitude);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(sums[i], sums_with_flat[i], 1e-12 * test::largest(sums));
    }
    EXPECT_NEAR(steps.energy(x), steps_with_flat.energy(x), 1e-13 * steps.energy(x));
  }
}

TEST_P(LocalPasses, HaveTheEnergyOfTheirDefinition) {
  const LocalLaw law = test::law_of(GetParam());
  const test::Patch patch = test::tetrahedra(50);
  for (const double amplitude : {1e-3, 0.05, 3.0}) {
    const AlignedVector<double> x = test::shaken(patch, 3, amplitude);
    double expected = 0.0;
    for (const DenseElement& element : dense_elements(law, patch)) {
      const Eigen::VectorXd q = element.d * unpadded(x, index_size(patch.points));
      if (law.model == LocalModel::springs) {
        expected += 0.5 * law.stiffness * std::pow(q.norm() - element.rest.norm(), 2);
      } else {
        const Eigen::Matrix3d f = Eigen::Map<const Eigen::Matrix3d>(q.data());
        expected += element.weight / test::weight_of(law) * test::density(law, test::singular_values(f));
      }
    }
    const double actual = test::steps_of(law, patch).energy(x);
    if (std::isinf(expected)) {
      EXPECT_EQ(actual, expected);
      EXPECT_EQ(law.model, LocalModel::log_neo_hookean);
      continue;
    }
    EXPECT_NEAR(actual, expected, 1e-9 * expected);
    const AlignedVector<float> x_of_floats(x.begin(), x.end());
    EXPECT_NEAR(test::steps_of<float>(law, patch).energy(x_of_floats), expected, 2e-2 * expected + 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, LocalPasses,
                         testing::Values(LocalModel::springs, LocalModel::strain, LocalModel::stvk,
                                         LocalModel::neo_hookean, LocalModel::log_neo_hookean),
                         [](const auto& law) { return test::name_of(law.param); });

TEST(LocalSteps, RefuseOtherBodiesAndArrays) {
  const test::Patch patch = test::tetrahedra(3);
  const LocalLaw law = test::law_of(LocalModel::strain);
  const auto refused = [&](const Simplices& simplices, const std::vector<Point>& points) {
    EXPECT_THROW(LocalSteps<double>(law, simplices, points), InvalidArgument);
  };
  refused({}, patch.points);
  const test::Patch triangles = test::deformed_patch(2, 4);
  refused(triangles.simplices, triangles.points);
  refused(patch.simplices, {patch.points.begin(), patch.points.end() - 1});
  std::vector<Point> points = patch.points;
  points[2][1] = std::numeric_limits<double>::quiet_NaN();
  refused(patch.simplices, points);

  auto steps = test::steps_of(law, patch);
  AlignedVector<double> sums = test::sums_for(steps);
  AlignedVector<double> x = padded_positions(patch.points);
  sums.pop_back();
  EXPECT_THROW(steps.pass(x, 1.0, sums), InvalidArgument);
  sums.push_back(0.0);
  x.pop_back();
  EXPECT_THROW(steps.pass(x, 1.0, sums), InvalidArgument);
  EXPECT_THROW((void)steps.energy(x), InvalidArgument);
  std::vector<double> duals = steps.duals();
  duals[1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(steps.set_duals(duals), InvalidArgument);
  duals.pop_back();
  EXPECT_THROW(steps.set_duals(duals), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
