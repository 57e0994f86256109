// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/motion_metrics.hpp"

#include "base/random.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

struct Cloud {
  std::vector<Point> points;
  std::vector<Index> vertices;
};

Cloud random_cloud(Index n) {
  Cloud cloud;
  Random random(3);
  for (Index v = 0; v < n; ++v) cloud.points.push_back({random.unit(), 2 * random.unit(), 3 * random.unit()});
  cloud.vertices.resize(n);
  std::iota(cloud.vertices.begin(), cloud.vertices.end(), 0);
  return cloud;
}

TEST(Shape, ARigidMotionIsNoDistance) {
  const Cloud cloud = random_cloud(50);
  std::vector<Point> moved = cloud.points;
  for (Point& p : moved) p = {5 - p[1], 7 + p[0], p[2] - 2};  // a quarter turn about z
  EXPECT_NEAR(distance_from_shape(cloud.points, moved, cloud.vertices), 0.0, 1e-14);
}

TEST(Shape, AMirrorImageIsNotTheShape) {
  const Cloud cloud = random_cloud(50);
  std::vector<Point> mirrored = cloud.points;
  for (Point& p : mirrored) p[0] = -p[0];
  EXPECT_GT(distance_from_shape(cloud.points, mirrored, cloud.vertices), 0.3);
}

TEST(Shape, IsTheLargestDistanceAfterTheBestFit) {
  // stretched along z about the mean, which needs no rotation
  const std::vector<Point> rest{{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  std::vector<Point> stretched = rest;
  for (Point& p : stretched) p[2] *= 1.25;
  const std::vector<Index> all{0, 1, 2, 3, 4, 5};
  EXPECT_NEAR(distance_from_shape(rest, stretched, all), 0.25, 1e-15);
  // vertices that are left out do not count
  stretched[2][0] = 100;
  const std::vector<Index> most{0, 1, 4, 5};
  EXPECT_NEAR(distance_from_shape(rest, stretched, most), 0.25, 1e-15);
  EXPECT_EQ(distance_from_shape(rest, stretched, {}), 0.0);
}

TEST(Shape, ABodyAtOnePointIsAsFarAsItReaches) {
  const Cloud cloud = random_cloud(20);
  const std::vector<Point> squashed(20, Point{9, 9, 9});
  Point mean{};
  for (const Point& p : cloud.points) {
    for (int c = 0; c < 3; ++c) mean[c] += p[c] / 20;
  }
  double expected = 0.0;
  for (const Point& p : cloud.points)
    expected = std::max(expected, std::hypot(p[0] - mean[0], p[1] - mean[1], p[2] - mean[2]));
  EXPECT_NEAR(distance_from_shape(cloud.points, squashed, cloud.vertices), expected, 1e-12);
}

Motion two_frames() { return {2, {{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}, {1, 0, 1}}}}; }

TEST(MotionDifference, IsTheLargestDistanceOfAVertexFromItself) {
  Motion moved = two_frames();
  moved.frames[1][0] = {3, 4, 1};  // 5 away
  moved.frames[1][1] = {1, 2, 1};  // 2 away
  const MotionDifference difference = difference_of(moved, two_frames(), 10);
  EXPECT_EQ(difference.by_frame, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(difference.largest, 0.5);
}

TEST(MotionDifference, RefusesAnotherBodyAndOtherFrames) {
  Motion other = two_frames();
  other.frames.pop_back();
  EXPECT_THROW(difference_of(other, two_frames(), 1), InvalidArgument);
  EXPECT_THROW(difference_of({1, {{{0, 0, 0}}, {{0, 0, 0}}}}, two_frames(), 1), InvalidArgument);
}

}  // namespace
}  // namespace meshorder
