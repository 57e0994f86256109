// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/geometry/box_tree.hpp"

#include "lab/contact/geometry/simplex_point.hpp"
#include "simulators/surfaces.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace meshorder {
namespace {

std::vector<Box> random_boxes(Index count, double size, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    const Point a = test::random_point(random, 1.0);
    box.include(a);
    box.include(plus_scaled(a, 1.0, test::random_point(random, size)));
  }
  return boxes;
}

TEST(BoxTree, FindsTheNearestOfAnyNumberOfBoxes) {
  for (const Index count : {0, 1, 2, 4, 5, 9, 100, 1000}) {
    const std::vector<Box> boxes = random_boxes(count, 0.1, 1);
    const BoxTree tree(boxes);
    Random random(2);
    for (int i = 0; i < 200; ++i) {
      const Point x = test::random_point(random, 1.5);
      double smallest = Box::kInfinity;
      for (const Box& box : boxes) smallest = std::min(smallest, box.squared_distance(x));
      double found = Box::kInfinity;
      tree.visit_nearest(x, [&](Index thing) {
        found = std::min(found, boxes[thing].squared_distance(x));
        return found;
      });
      EXPECT_EQ(found, smallest) << count;
    }
  }
}

TEST(BoxTree, VisitsFewThings) {
  const std::vector<Box> boxes = random_boxes(10000, 0.01, 3);
  const BoxTree tree(boxes);
  Random random(4);
  Index visits = 0;
  for (int i = 0; i < 100; ++i) {
    const Point x = test::random_point(random, 1.0);
    double found = Box::kInfinity;
    tree.visit_nearest(x, [&](Index thing) {
      ++visits;
      found = std::min(found, boxes[thing].squared_distance(x));
      return found;
    });
  }
  EXPECT_LT(visits, 100 * 200);
}

/// Whether a segment meets a box, by clipping it to the box's three slabs.
bool meets(const Box& box, const Point& a, const Point& b) {
  double from = 0.0;
  double to = 1.0;
  for (int c = 0; c < 3; ++c) {
    const double way = b[c] - a[c];
    double enter = (box.lower[c] - a[c]) / way;
    double leave = (box.upper[c] - a[c]) / way;
    if (enter > leave) std::swap(enter, leave);
    from = std::max(from, enter);
    to = std::min(to, leave);
  }
  return from <= to;
}

TEST(BoxTree, FindsAllOnASegment) {
  const std::vector<Box> boxes = random_boxes(500, 0.3, 5);
  const BoxTree tree(boxes);
  Random random(6);
  Index found = 0;
  for (int i = 0; i < 300; ++i) {
    const Point a = test::random_point(random, 1.2);
    const Point b = test::random_point(random, 1.2);
    std::set<Index> met;
    tree.visit_on_segment(a, b, [&](Index thing) {
      if (boxes[thing].meets_segment(a, b)) met.insert(thing);
    });
    std::set<Index> expected;
    for (Index thing = 0; thing < 500; ++thing) {
      if (meets(boxes[thing], a, b)) expected.insert(thing);
    }
    EXPECT_EQ(met, expected);
    found += index_size(expected);
  }
  EXPECT_GT(found, 500);
}

TEST(BoxTree, TakesPointsThatAreNotFinite) {
  const BoxTree tree(random_boxes(100, 0.1, 7));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Index visits = 0;
  tree.visit_nearest({nan, 0, 0}, [&](Index) { return static_cast<double>(++visits); });
  tree.visit_on_segment({nan, 0, 0}, {1, nan, nan}, [&](Index) { ++visits; });
  EXPECT_LE(visits, 200);
}

TEST(SortIntoRuns, KeepsRunsCompact) {
  Random random(8);
  std::vector<Point> points(1000);
  for (Point& p : points) p = test::random_point(random, 1.0);
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  sort_into_runs(order, 16, points);
  EXPECT_EQ(std::set(order.begin(), order.end()).size(), points.size());
  double sum = 0.0;
  for (std::size_t first = 0; first < order.size(); first += 16) {
    Box box;
    for (std::size_t i = first; i < std::min(first + 16, order.size()); ++i) box.include(points[order[i]]);
    sum += (box.upper[0] - box.lower[0]) * (box.upper[1] - box.lower[1]) * (box.upper[2] - box.lower[2]);
  }
  EXPECT_LT(sum, 8.0) << "the boxes of runs would tile the cube of volume 8 if they were full";
}

TEST(NearestOnTriangle, IsAsNearAsThePlaneAndTheEdges) {
  Random random(9);
  std::array<int, 7> on{};
  for (int i = 0; i < 20000; ++i) {
    std::array<Point, 3> t{};
    for (Point& corner : t) corner = test::random_point(random, 1.0);
    if (i % 10 == 7) t[2] = plus_scaled(t[0], random.unit(), minus(t[1], t[0]));  // nearly flat
    if (i % 10 == 8) t[2] = t[0];
    if (i % 10 == 9) t[1] = t[2] = t[0];
    const Point x = test::random_point(random, 1.5);
    const TrianglePoint nearest = nearest_on_triangle(x, t[0], t[1], t[2]);
    const double expected = test::distance_to_triangle(x, t[0], t[1], t[2]);
    ASSERT_NEAR(std::sqrt(nearest.squared_distance), expected, 1e-7);
    ASSERT_NEAR(norm(minus(x, nearest.at)), expected, 1e-7);
    Point sum{};
    int positive = 0;
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(nearest.weights[k], 0.0);
      positive += nearest.weights[k] > 0.0 ? 1 : 0;
      sum = plus_scaled(sum, nearest.weights[k], t[k]);
    }
    ASSERT_NEAR(norm(minus(sum, nearest.at)), 0.0, 1e-7);
    ASSERT_NEAR(nearest.weights[0] + nearest.weights[1] + nearest.weights[2], 1.0, 1e-12);
    const int number = static_cast<int>(nearest.on);
    ASSERT_LE(positive, number < 3 ? 1 : number < 6 ? 2 : 3);
    if (number < 3) {
      ASSERT_EQ(nearest.weights[number], 1.0);
    }
    if (number >= 3 && number < 6) {
      ASSERT_EQ(nearest.weights[(number - 1) % 3], 0.0);
    }
    ++on[number];
  }
  for (const int count : on) EXPECT_GT(count, 500);
}

}  // namespace
}  // namespace meshorder
