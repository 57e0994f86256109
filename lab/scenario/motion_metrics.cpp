// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/motion_metrics.hpp"

#include "lab/support/rotation.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

Point mean(std::span<const Point> points, std::span<const Index> vertices) {
  Point sum{};
  for (const Index v : vertices) {
    for (int c = 0; c < 3; ++c) sum[c] += points[v][c];
  }
  for (double& x : sum) x /= static_cast<double>(vertices.size());
  return sum;
}

double distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return std::hypot(double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]}, double{a[2]} - double{b[2]});
}

}  // namespace

double distance_from_shape(std::span<const Point> rest, std::span<const Point> positions,
                           std::span<const Index> vertices) {
  if (vertices.empty()) return 0.0;
  const Point from = mean(rest, vertices);
  const Point to = mean(positions, vertices);
  Matrix3 correlation{};
  for (const Index v : vertices) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) correlation[i][j] += (positions[v][i] - to[i]) * (rest[v][j] - from[j]);
    }
  }
  const Matrix3 rotation = closest_rotation(correlation);
  double largest = 0.0;
  for (const Index v : vertices) {
    double squared = 0.0;
    for (int i = 0; i < 3; ++i) {
      double difference = positions[v][i] - to[i];
      for (int j = 0; j < 3; ++j) difference -= rotation[i][j] * (rest[v][j] - from[j]);
      squared += difference * difference;
    }
    largest = std::max(largest, squared);
  }
  return std::sqrt(largest);
}

MotionDifference difference_of(const Motion& motion, const Motion& reference, double longest_side) {
  if (motion.vertices != reference.vertices || motion.frames.size() != reference.frames.size())
    throw InvalidArgument("motions of different bodies, or with different frames, cannot be compared");
  MotionDifference difference;
  for (std::size_t frame = 0; frame < motion.frames.size(); ++frame) {
    double largest = 0;
    for (std::size_t v = 0; v < motion.frames[frame].size(); ++v)
      largest = std::max(largest, distance(motion.frames[frame][v], reference.frames[frame][v]));
    difference.by_frame.push_back(largest / longest_side);
    difference.largest = std::max(difference.largest, difference.by_frame.back());
  }
  return difference;
}

}  // namespace meshorder
