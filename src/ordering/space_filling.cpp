// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/space_filling.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace meshorder {

void check_points(std::span<const Point> points, std::size_t count, std::string_view method) {
  if (points.size() != count) {
    throw InvalidArgument("order '" + std::string(method) + "' needs the coordinates of all " +
                          std::to_string(count) + " vertices, got " + std::to_string(points.size()));
  }
}

LatticePoints on_lattice(std::span<const Point> points) {
  LatticePoints lattice;
  if (points.empty()) return lattice;

  // the bounding box, and its axes of any extent
  Point low = points.front();
  Point high = points.front();
  for (const Point& point : points) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], point[a]);
      high[a] = std::max(high[a], point[a]);
    }
  }
  std::array<int, 3> used{};
  lattice.axes = 0;
  double extent = 0;
  for (int a = 0; a < 3; ++a) {
    if (!(high[a] > low[a])) continue;
    used[lattice.axes++] = a;
    extent = std::max(extent, high[a] - low[a]);
  }
  lattice.bits = lattice.axes == 3 ? 21 : 31;

  // one scale for all axes, so that cells are cubes
  const double cells = std::ldexp(1.0, lattice.bits) - 1;
  lattice.coordinates.assign(points.size(), {0, 0, 0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < lattice.axes; ++k) {
      const double share = (points[i][used[k]] - low[used[k]]) / extent;
      lattice.coordinates[i][k] = static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * cells);
    }
  }
  return lattice;
}

std::uint64_t interleaved(const std::array<std::uint32_t, 3>& coordinates, int axes, int bits) {
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    for (int a = 0; a < axes; ++a) key = key << 1U | (coordinates[a] >> static_cast<unsigned>(bit) & 1U);
  }
  return key;
}

}  // namespace meshorder
