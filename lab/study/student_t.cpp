// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/student_t.hpp"

#include "base/error.hpp"

#include <cmath>
#include <numbers>

namespace meshorder {
namespace {

/// The probability of |t| ≤ √degrees · tan angle.
double probability_within(double angle, Index degrees) {
  const bool odd = degrees % 2 == 1;
  const double cosine = std::cos(angle);
  double term = odd ? cosine : 1.0;
  double sum = degrees == 1 ? 0.0 : term;
  for (Index power = odd ? 3 : 2; power <= degrees - 2; power += 2) {
    term *= cosine * cosine * (power - 1) / power;
    sum += term;
  }
  const double series = std::sin(angle) * sum;
  return odd ? 2.0 / std::numbers::pi * (angle + series) : series;
}

}  // namespace

double student_t(Index degrees, double probability) {
  if (degrees < 1) throw InvalidArgument("student_t: less than one degree of freedom");
  if (!(probability > 0.0 && probability < 1.0))
    throw InvalidArgument("student_t: a probability that is not between 0 and 1");
  double low = 0.0;
  double high = std::numbers::pi / 2;
  constexpr int kBitsOfDouble = 53;
  for (int i = 0; i < kBitsOfDouble; ++i) {
    const double middle = 0.5 * (low + high);
    (probability_within(middle, degrees) < probability ? low : high) = middle;
  }
  return std::sqrt(degrees) * std::tan(0.5 * (low + high));
}

}  // namespace meshorder
