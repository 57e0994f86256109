// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/points_fit.hpp"

#include "base/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

bool points_fit(GraphRef graph, const PointsView& points) {
  constexpr Index kFewest = 256;
  constexpr int kSamples = 256;
  // in meshes of 256 vertices neighbours are half as far apart as any two vertices, in larger ones nearer
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
