// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/input_checks.hpp"

#include "base/run_scope.hpp"
#include <meshorder/error.hpp>

#include <cmath>
#include <string>

namespace meshorder {

void check_finite(const PointsView& points, std::size_t count, Check check) {
  if (points.size() == 0 || check == Check::none) return;
  if (points.size() != count) {
    throw InvalidArgument("points: " + std::to_string(points.size()) + " points for " +
                          std::to_string(count) + " vertices");
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    poll_in_loop(p);
    for (int axis = 0; axis < points.dimension(); ++axis) {
      if (std::isfinite(points(p, axis))) continue;
      throw InvalidArgument("points: coordinate " + std::to_string(axis) + " of point " + std::to_string(p) +
                            " is not finite");
    }
  }
}

}  // namespace meshorder
