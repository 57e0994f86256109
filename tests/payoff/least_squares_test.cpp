// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/least_squares.hpp"

#include "base/random.hpp"
#include <meshorder/error.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace meshorder {
namespace {

Eigen::MatrixXd dense(const Rows& rows) {
  Eigen::MatrixXd result(rows.size(), rows.columns);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.columns; ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j];
  }
  return result;
}

double squares_left(const Rows& rows, const std::vector<double>& right, const std::vector<double>& x) {
  const Eigen::VectorXd given =
      Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  const Eigen::VectorXd wanted =
      Eigen::Map<const Eigen::VectorXd>(right.data(), static_cast<Eigen::Index>(right.size()));
  return (dense(rows) * given - wanted).squaredNorm();
}

/// The least sum of squares over all choices of unknowns that are 0, if the free ones come out non-negative.
double least_by_trying_all(const Rows& rows, const std::vector<double>& right) {
  const Eigen::MatrixXd all = dense(rows);
  const Eigen::VectorXd wanted =
      Eigen::Map<const Eigen::VectorXd>(right.data(), static_cast<Eigen::Index>(right.size()));
  double least = wanted.squaredNorm();
  for (unsigned set = 1; set < 1U << rows.columns; ++set) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index j = 0; j < all.cols(); ++j) {
      if ((set >> static_cast<unsigned>(j) & 1U) != 0) free.push_back(j);
    }
    const Eigen::MatrixXd some = all(Eigen::all, free);
    const Eigen::VectorXd x = some.colPivHouseholderQr().solve(wanted);
    if (x.minCoeff() < 0) continue;
    least = std::min(least, (some * x - wanted).squaredNorm());
  }
  return least;
}

TEST(LeastSquares, NoChoiceOfUnknownsLeavesLess) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    Rows rows{.columns = 1 + static_cast<std::size_t>(random.below(8))};
    const std::size_t count = rows.columns + static_cast<std::size_t>(random.below(10));
    std::vector<double> right;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> row;
      // columns of positive numbers are closer to linear dependence; magnitudes differ like those of counts
      for (std::size_t j = 0; j < rows.columns; ++j)
        row.push_back((random.unit() - (round % 2 == 0 ? 0.5 : 0)) *
                      std::pow(10, static_cast<double>(j % 4)));
      rows.push_back(row);
      right.push_back(random.unit() - 0.3);
    }
    const std::vector<double> x = non_negative_least_squares(rows, right);
    for (const double value : x) EXPECT_GE(value, 0);
    const double least = least_by_trying_all(rows, right);
    EXPECT_NEAR(squares_left(rows, right, x), least, 1e-9 * (1 + least)) << "round " << round;
  }
}

TEST(LeastSquares, UnknownsWithoutDataAreZero) {
  Rows rows{.columns = 3};
  for (const double t : {1.0, 2.0, 3.0}) rows.push_back(std::vector{t, 0.0, t});
  const std::vector<double> x = non_negative_least_squares(rows, std::vector{2.0, 4.0, 6.0});
  EXPECT_DOUBLE_EQ(x[0] + x[2], 2);
  EXPECT_EQ(x[1], 0);
  EXPECT_EQ(x[0] * x[2], 0);
}

TEST(LeastSquares, RefusesAnotherNumberOfValues) {
  const Rows rows{.columns = 1, .values = {1, 2}};
  EXPECT_THROW((void)non_negative_least_squares(rows, std::vector{1.0}), InvalidArgument);
}

TEST(ConditionNumber, IsThatOfTheScaledColumns) {
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    Rows rows{.columns = 2 + static_cast<std::size_t>(random.below(7))};
    for (std::size_t i = 0; i < 12; ++i) {
      std::vector<double> row;
      for (std::size_t j = 0; j < rows.columns; ++j) row.push_back(random.unit() * std::pow(10, j));
      rows.push_back(row);
    }
    const Eigen::MatrixXd scaled = dense(rows).colwise().normalized();
    const Eigen::VectorXd values = scaled.jacobiSvd().singularValues();
    const double expected = values(0) / values(values.size() - 1);
    EXPECT_NEAR(condition_number(rows), expected, 1e-6 * expected);
  }
}

TEST(ConditionNumber, ZerosDoNotCountAndCopiesAreInfinite) {
  EXPECT_DOUBLE_EQ(condition_number({.columns = 2, .values = {1, 0, 2, 0}}), 1);
  EXPECT_DOUBLE_EQ(condition_number({.columns = 1, .values = {0}}), 1);
  EXPECT_EQ(condition_number({.columns = 2, .values = {1, 10, 2, 20}}),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace meshorder
