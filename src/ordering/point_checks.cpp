// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/point_checks.hpp"

#include "base/random.hpp"
#include "base/run_scope.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace meshorder {
namespace {

double distance(const PointsView& points, std::size_t a, std::size_t b) {
  double sum = 0;
  for (int axis = 0; axis < points.dimension(); ++axis) {
    const double difference = points(a, axis) - points(b, axis);
    sum += difference * difference;
  }
  return std::sqrt(sum);
}

}  // namespace

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

bool points_fit(GraphRef graph, const PointsView& points) {
  constexpr Index kFewest = 256;
  constexpr int kSamples = 256;
  // neighbours are half as far apart as any two vertices in meshes of 256 vertices, and nearer in larger
  // meshes
  constexpr double kAsFar = 0.8;
  const Index n = graph.size();
  if (n < kFewest || points.empty() || graph.neighbours.empty()) return true;
  Random random(0);
  const auto below = [&](std::size_t bound) { return static_cast<std::size_t>(random.below(bound)); };
  double of_neighbours = 0;
  double of_any = 0;
  for (int i = 0; i < kSamples; ++i) {
    const std::size_t entry = below(graph.neighbours.size());
    const auto end = std::ranges::upper_bound(graph.offsets, static_cast<Offset>(entry));
    const auto v = static_cast<std::size_t>(end - graph.offsets.begin()) - 1;
    of_neighbours += distance(points, v, static_cast<std::size_t>(graph.neighbours[entry]));
    of_any += distance(points, v, below(static_cast<std::size_t>(n)));
  }
  return !(of_neighbours > kAsFar * of_any);
}

}  // namespace meshorder
