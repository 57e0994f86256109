// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/geometry/inside_tetrahedron.hpp"

#include "base/point.hpp"
#include "lab/contact/geometry/box_tree.hpp"

#include <algorithm>

namespace meshorder {

std::optional<std::array<double, 4>> weights_inside(const Point& x, const std::array<Point, 4>& corners) {
  constexpr double kPart = 1e-6;
  constexpr double kRounding = 1e-12;
  Box box;
  std::array<Point, 4> to{};
  for (int k = 0; k < 4; ++k) {
    box.include(corners[k]);
    to[k] = minus(corners[k], x);
  }
  if (!box.contains(x)) return std::nullopt;
  const Point sides = minus(box.upper, box.lower);
  const double longest = std::max({sides[0], sides[1], sides[2]});
  // six times the volumes that x spans with the faces opposite to the corners
  std::array<double, 4> volumes{dot(to[1], cross(to[2], to[3])), dot(to[0], cross(to[3], to[2])),
                                dot(to[0], cross(to[1], to[3])), dot(to[0], cross(to[2], to[1]))};
  const double all = volumes[0] + volumes[1] + volumes[2] + volumes[3];
  const double min_volume = kPart * all + kRounding * longest * longest * longest;
  bool inside = true;
  for (double& volume : volumes) {
    inside = inside && volume > min_volume;
    volume /= all;
  }
  if (!inside) return std::nullopt;
  return volumes;
}

}  // namespace meshorder
