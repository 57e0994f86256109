// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/values.hpp"
#include <meshorder/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder {

/// Returns whether the type `To` can hold a number exactly. Only real types hold NaN and infinity. A real
/// type holds integers up to ±2^(bits of its significand).
template <class To, class From>
bool is_exact(From value) {
  constexpr int kDigits = std::numeric_limits<To>::digits;
  if constexpr (std::is_integral_v<From> && std::is_integral_v<To>) {
    return std::in_range<To>(value);
  } else if constexpr (std::is_integral_v<From>) {
    constexpr std::int64_t kMost = std::int64_t{1} << kDigits;
    return std::cmp_less_equal(value, kMost) && std::cmp_greater_equal(value, -kMost);
  } else if constexpr (std::is_integral_v<To>) {
    const double number = value;
    return number == std::trunc(number) && number >= static_cast<double>(std::numeric_limits<To>::min()) &&
           number < std::ldexp(1.0, kDigits);
  } else if constexpr (sizeof(From) > sizeof(To)) {
    if (!std::isfinite(value)) return true;
    return std::abs(value) <= std::numeric_limits<To>::max() && From{static_cast<To>(value)} == value;
  } else {
    return true;
  }
}

/// Returns whether `To` can hold all values exactly; false for texts. O(1) if the values are of type `To`,
/// else O(values).
template <class To>
bool are_exact(const Values& values) {
  return with_numbers(values, []<class From>(const std::vector<From>& all) {
    return std::is_same_v<From, To> ||
           std::all_of(all.begin(), all.end(), [](From value) { return is_exact<To>(value); });
  });
}

/// Returns whether `float` can hold all coordinates exactly. O(points).
inline bool are_float_points(const std::vector<Point>& points) {
  return std::all_of(points.begin(), points.end(), [](const Point& point) {
    return std::all_of(point.begin(), point.end(),
                       [](double x) { return double{static_cast<float>(x)} == x; });
  });
}

/// Returns how many coordinates a file needs for each point: 3 if any z is not 0, else 2 if any y is not 0;
/// at least `of_file`. O(points).
inline int coordinates_of(const std::vector<Point>& points, int of_file) {
  int needed = of_file;
  for (const Point& point : points) {
    if (point[2] != 0) return 3;
    if (point[1] != 0) needed = std::max(needed, 2);
  }
  return needed;
}

}  // namespace meshorder
