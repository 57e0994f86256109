// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/student_t.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace meshorder {
namespace {

struct Quantile {
  Index degrees;
  double of_95, of_99;
};

TEST(StudentT, IsThatOfSciPy) {
  // scipy.stats.t.ppf([0.975, 0.995], degrees) of SciPy 1.10.1, good to 2e-9
  for (const Quantile& q :
       {Quantile{1, 12.706204736432095, 63.65674116287399}, Quantile{2, 4.302652729911275, 9.92484320091807},
        Quantile{3, 3.182446305284263, 5.84090929975643}, Quantile{4, 2.7764451051977987, 4.604094871415897},
        Quantile{5, 2.5705818366147395, 4.032142983557536},
        Quantile{30, 2.0422724563012373, 2.7499956535670305},
        Quantile{476, 1.964960228540678, 2.5861972903853063},
        Quantile{2000, 1.9611508260994375, 2.5782897875575186}}) {
    EXPECT_NEAR(student_t(q.degrees, 0.95), q.of_95, 1e-8 * q.of_95) << q.degrees;
    EXPECT_NEAR(student_t(q.degrees, 0.99), q.of_99, 1e-8 * q.of_99) << q.degrees;
  }
}

TEST(StudentT, IsThatOfTheClosedForms) {
  for (const double p : {0.5, 0.95, 0.999}) {
    EXPECT_NEAR(student_t(1, p), std::tan(p * std::numbers::pi / 2), 1e-12 * student_t(1, p));
    EXPECT_NEAR(student_t(2, p), p * std::sqrt(2 / (1 - p * p)), 1e-12 * student_t(2, p));
  }
}

TEST(StudentT, RefusesWhatIsNoDistribution) {
  EXPECT_THROW(student_t(0, 0.95), InvalidArgument);
  EXPECT_THROW(student_t(1, 1), InvalidArgument);
  EXPECT_THROW(student_t(1, 0), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
