// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/scenario_obstacles.hpp"

#include "lab/scenario/fingerprint.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using Kind = ScenarioObstacle::Kind;

std::vector<ScenarioObstacle> one_of_each() {
  ScenarioObstacle floor;
  floor.place = {1, 2, 3};
  floor.direction = {0, 2, 1};
  ScenarioObstacle ball;
  ball.kind = Kind::sphere;
  ball.place = {4, 0, 0};
  ball.radius = 1.5;
  ScenarioObstacle shell;
  shell.kind = Kind::bowl;
  shell.place = {0, 0, 9};
  shell.direction = {1, 1, 0};
  shell.radius = 2;
  shell.thickness = 0.2;
  shell.opening = 50;
  return {floor, ball, shell};
}

TEST(Obstacles, WhatIsShownIsTheirSurface) {
  const std::vector<ScenarioObstacle> obstacles = one_of_each();
  for (const ScenarioObstacle& obstacle : obstacles) {
    const Mesh mesh = surfaces_of(std::vector{obstacle}, 0.5);
    const auto exact = obstacle_of(obstacle);
    ASSERT_GT(mesh.vertex_count(), 100);
    for (const Point& point : mesh.points) EXPECT_NEAR(exact->distance(point), 0.0, 1e-12);
    // all of it is shown: for points around, the distances from the obstacle and from the shown mesh agree
    for (const double x : {-1.2, 0.1, 0.9, 1.7}) {
      for (const double y : {-1.1, 0.3, 1.3}) {
        const Point near{obstacle.place[0] + x, obstacle.place[1] + y, obstacle.place[2] + 0.4};
        double shown = 1e9;
        for (const Point& p : mesh.points)
          shown = std::min(shown, std::hypot(p[0] - near[0], p[1] - near[1], p[2] - near[2]));
        if (obstacle.kind == Kind::half_space) continue;  // only a part is shown
        EXPECT_NEAR(std::abs(exact->distance(near)), shown, 0.08);
      }
    }
  }
}

TEST(Obstacles, AreNumberedAsInTheScenario) {
  const Mesh mesh = surfaces_of(one_of_each(), 1.0);
  const auto& numbers =
      std::get<std::vector<std::int32_t>>(find_array(mesh, "obstacle", Association::cells)->values);
  ASSERT_EQ(numbers.size(), mesh.cells.shapes.size());
  EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
  EXPECT_EQ(numbers.front(), 0);
  EXPECT_EQ(numbers.back(), 2);
}

TEST(Obstacles, CountForTheFingerprintWithTheirFiles) {
  const test::TemporaryFolder folder;
  ProjectiveScenario scenario;
  scenario.obstacles.resize(1);
  scenario.obstacles[0].kind = Kind::surface;
  scenario.obstacles[0].folder = folder.path();
  const auto checksum_with = [&](const std::string& content) {
    scenario.obstacles[0].file = folder.file("bowl.off", content);
    return checksum_of(ProjectiveOptions{}, scenario, ProjectiveBody{}, MotionState{});
  };
  const std::uint64_t first = checksum_with("OFF 1");
  EXPECT_NE(checksum_with("OFF 2"), first);
  EXPECT_EQ(checksum_with("OFF 1"), first);
}

TEST(Obstacles, AreReadFromClosedSurfacesAlone) {
  const test::TemporaryFolder folder;
  ScenarioObstacle obstacle;
  obstacle.kind = Kind::surface;
  const auto write = [&](const std::string& faces) {
    obstacle.folder = folder.path();
    obstacle.file = folder.file("tetrahedron.off", "OFF\n4 " + std::to_string(faces.size() / 8) +
                                                       " 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + faces);
  };
  write("3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  EXPECT_NEAR(obstacle_of(obstacle)->distance({0.1, 0.3, 0.3}), -0.1, 1e-12);
  EXPECT_EQ(surfaces_of(std::vector{obstacle}, 1.0).cell_count(), 4);
  write("3 0 2 1\n3 0 1 3\n3 0 3 2\n");
  EXPECT_THROW((void)obstacle_of(obstacle), InputError);
  write("3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 3 2\n");
  EXPECT_THROW((void)obstacle_of(obstacle), InputError);
}

}  // namespace
}  // namespace meshorder
