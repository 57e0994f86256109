// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/error.hpp>
#include <meshorder/view.hpp>

#include <cstddef>
#include <string>

namespace meshorder {

void detail::refuse_null(std::size_t count) {
  throw InvalidArgument("an array of " + std::to_string(count) + " numbers is null");
}

void PointsView::check_dimension(int dimension) {
  if (dimension < 1 || dimension > 3) {
    throw InvalidArgument("points: the dimension is " + std::to_string(dimension) + ", must be 1, 2 or 3");
  }
}

std::size_t PointsView::point_count(std::size_t numbers, int dimension) {
  check_dimension(dimension);
  const auto axes = static_cast<std::size_t>(dimension);
  if (numbers % axes != 0) {
    throw InvalidArgument("points: " + std::to_string(numbers) + " numbers do not make points of " +
                          std::to_string(dimension) + " coordinates");
  }
  return numbers / axes;
}

}  // namespace meshorder
