// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/random.hpp"
#include "payoff/elastic.hpp"
#include "simulators/local_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace meshorder {
namespace {

constexpr double kPoisson[] = {0.0, 0.3, 0.45, 0.49};

class LocalMinimum : public testing::TestWithParam<LocalModel> {};

/// The identity plus up to `amplitude` in each entry.
std::vector<Eigen::Matrix3d> around_rest(std::size_t count, double amplitude, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Matrix3d> result(count, Eigen::Matrix3d::Identity());
  for (Eigen::Matrix3d& q : result) {
    for (int k = 0; k < 9; ++k) q(k / 3, k % 3) += amplitude * (2 * random.unit() - 1);
  }
  return result;
}

/// The singular values of the step by brute force: the best point of a lattice, improved by ever smaller
/// steps.
Eigen::Vector3d best_values(const LocalLaw& law, const Eigen::Vector3d& sigma) {
  const double weight = test::weight_of(law);
  const auto cost = [&](const Eigen::Vector3d& z) {
    return test::density(law, z) / weight + 0.5 * (z - sigma).squaredNorm();
  };
  constexpr double kSpacing = 0.2;
  Eigen::Vector3d best(1, 1, 1);
  double smallest = cost(best);
  const auto take = [&](const Eigen::Vector3d& z) {
    const double there = cost(z);
    if (!(there < smallest)) return false;
    smallest = there;
    best = z;
    return true;
  };
  for (double x = -0.9; x < 2.6; x += kSpacing) {
    for (double y = -0.9; y < 2.6; y += kSpacing) {
      for (double z = -0.9; z < 2.6; z += kSpacing) take({x, y, z});
    }
  }
  for (double step = kSpacing; step > 1e-8; step *= 0.5) {
    bool better = true;
    while (better) {
      better = false;
      for (int k = 0; k < 27; ++k) {
        const int along[3] = {k % 3, k / 3 % 3, k / 9};
        const Eigen::Vector3d direction(along[0] - 1, along[1] - 1, along[2] - 1);
        better = take(best + step * direction) || better;
      }
    }
  }
  return best;
}

/// EXPECTs that no change of any entry lowers the objective, and that its slope is 0.
void expect_minimum(const LocalLaw& law, const Eigen::Matrix3d& z, const Eigen::Matrix3d& q,
                    double tolerance) {
  const double here = test::objective(law, z, q);
  ASSERT_TRUE(std::isfinite(here)) << q;
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 9; ++k) {
    Eigen::Matrix3d moved = z;
    moved(k / 3, k % 3) += kStep;
    const double above = test::objective(law, moved, q);
    moved(k / 3, k % 3) -= 2 * kStep;
    const double below = test::objective(law, moved, q);
    EXPECT_NEAR((above - below) / (2 * kStep), 0.0, tolerance) << q;
  }
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    Eigen::Matrix3d moved = z;
    for (int k = 0; k < 9; ++k) moved(k / 3, k % 3) += 1e-3 * (2 * random.unit() - 1);
    EXPECT_GT(test::objective(law, moved, q), here - 1e-13) << q;
  }
}

TEST_P(LocalMinimum, IsThatOfBruteForce) {
  for (const double poisson : kPoisson) {
    const LocalLaw law = test::law_of(GetParam(), poisson);
    for (const double amplitude : {0.05, 0.3, 0.6}) {
      const auto q = around_rest(40, amplitude, 7);
      const auto z = test::local_steps<double>(law, q);
      for (std::size_t i = 0; i < q.size(); ++i) {
        SCOPED_TRACE(testing::Message() << poisson << ", " << amplitude << "\n" << q[i]);
        Eigen::Vector3d expected = best_values(law, test::singular_values(q[i]));
        const Eigen::Vector3d actual = test::singular_values(z[i]);
        std::sort(expected.begin(), expected.end(),
                  [](double a, double b) { return std::abs(a) > std::abs(b); });
        // the search stops where the objective is flat to rounding
        EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-6);
        expect_minimum(law, z[i], q[i], 1e-8);
      }
    }
  }
}

TEST_P(LocalMinimum, IsStationaryFarFromRest) {
  for (const double poisson : kPoisson) {
    const LocalLaw law = test::law_of(GetParam(), poisson);
    for (const double amplitude : {1.0, 2.0, 5.0}) {
      const auto q = around_rest(300, amplitude, 8);
      const auto z = test::local_steps<double>(law, q);
      for (std::size_t i = 0; i < q.size(); ++i) {
        SCOPED_TRACE(testing::Message() << poisson << ", " << amplitude);
        expect_minimum(law, z[i], q[i], 1e-6 * amplitude * amplitude);
      }
    }
  }
}

TEST_P(LocalMinimum, ExistsInSingularStates) {
  for (const double poisson : kPoisson) {
    const LocalLaw law = test::law_of(GetParam(), poisson);
    for (const test::State& state : test::states()) {
      SCOPED_TRACE(testing::Message() << poisson << ", " << state.name);
      const Eigen::Matrix3d q = test::gradient_of(state);
      const Eigen::Matrix3d z = test::local_steps<double>(law, {q}).front();
      const double here = test::objective(law, z, q);
      ASSERT_TRUE(std::isfinite(here));
      const double there = test::objective(law, q, q);
      EXPECT_LE(here, there + 1e-12);
      // U and V are those of q
      EXPECT_LT((z.transpose() * q - q.transpose() * z).cwiseAbs().maxCoeff(),
                1e-11 * (1.0 + q.norm() * z.norm()));
      EXPECT_LT((z * q.transpose() - q * z.transpose()).cwiseAbs().maxCoeff(),
                1e-11 * (1.0 + q.norm() * z.norm()));
    }
  }
}

TEST_P(LocalMinimum, IsFiniteForAnythingFinite) {
  const LocalLaw law = test::law_of(GetParam(), 0.45);
  Random random(3);
  std::vector<Eigen::Matrix3d> q;
  for (const double scale :
       {0.0, 1e-310, 1e-200, 1e-100, 1e-30, 1e-3, 1.0, 30.0, 1e3, 1e5, 1e30, 1e100, 1e200, 1e307}) {
    for (int i = 0; i < 40; ++i) {
      Eigen::Matrix3d f =
          test::gradient_of({"", {random.unit(), i % 3 * random.unit(), (i % 5 - 2) * random.unit()}}, i);
      if (i % 7 == 0) f.col(1).setZero();
      q.emplace_back(scale * f);
    }
  }
  for (const Eigen::Matrix3d& z : test::local_steps<double>(law, q)) EXPECT_TRUE(z.allFinite()) << z;
}

TEST_P(LocalMinimum, TakesStretchesBeyondTenThousandForThat) {
  if (GetParam() == LocalModel::strain) return;
  const LocalLaw law = test::law_of(GetParam(), 0.3);
  const std::vector<Eigen::Matrix3d> q{test::gradient_of({"", {1e7, 1.2, 0.8}}),
                                       test::gradient_of({"", {1e4, 1.2, 0.8}})};
  const Eigen::Vector3d expected = test::singular_values(test::local_steps<double>(law, q)[1]);
  // 2z − q loses digits of z if q is much larger
  EXPECT_LT((test::singular_values(test::local_steps<double>(law, q)[0]) - expected).cwiseAbs().maxCoeff(),
            1e-6);
  EXPECT_LT(expected[0], 1e4);
}

TEST_P(LocalMinimum, IsNaNForWhatIsNotFinite) {
  const LocalLaw law = test::law_of(GetParam(), 0.45);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::vector<Eigen::Matrix3d> q(9, test::gradient_of({"", {1.2, 0.9, 0.3}}));
    q[4](1, 2) = bad;
    const auto z = test::local_steps<double>(law, q);
    for (std::size_t i = 0; i < q.size(); ++i) EXPECT_EQ(z[i].allFinite(), i != 4) << i;
  }
}

TEST_P(LocalMinimum, TurnsWithTheBody) {
  const LocalLaw law = test::law_of(GetParam(), 0.4);
  const Eigen::Matrix3d left = test::some_rotation(11);
  const Eigen::Matrix3d right = test::some_rotation(12);
  for (const double amplitude : {0.2, 0.6}) {
    const auto q = around_rest(200, amplitude, 9);
    std::vector<Eigen::Matrix3d> turned;
    turned.reserve(q.size());
    for (const Eigen::Matrix3d& f : q) turned.emplace_back(left * f * right);
    const auto z = test::local_steps<double>(law, q);
    const auto z_turned = test::local_steps<double>(law, turned);
    for (std::size_t i = 0; i < q.size(); ++i) {
      EXPECT_LT((z_turned[i] - left * z[i] * right).cwiseAbs().maxCoeff(), 1e-10);
    }
  }
}

TEST_P(LocalMinimum, IsTheSameWithEveryInstructionSet) {
  const LocalLaw law = test::law_of(GetParam(), 0.4);
  const auto q = around_rest(101, 0.5, 10);
  const auto expected = test::local_steps<double>(law, q);
  test::for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    const auto z = test::local_steps<double>(law, q);
    const auto of_floats = test::local_steps<float>(law, q);
    for (std::size_t i = 0; i < q.size(); ++i) {
      EXPECT_LT((z[i] - expected[i]).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((of_floats[i] - expected[i]).cwiseAbs().maxCoeff(), 2e-5);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Laws, LocalMinimum,
                         testing::Values(LocalModel::strain, LocalModel::stvk, LocalModel::neo_hookean,
                                         LocalModel::log_neo_hookean),
                         [](const auto& law) { return test::name_of(law.param); });

}  // namespace
}  // namespace meshorder
