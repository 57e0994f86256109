// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/scenario_obstacles.hpp"

#include "io/format.hpp"
#include <meshorder/error.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using Kind = ScenarioObstacle::Kind;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr int kAround = 96;  // number of corners of a circle

/// Reads the points and triangles of a surface's file.
std::pair<std::vector<Point>, std::vector<std::array<int, 3>>> read_surface(
    const ScenarioObstacle& obstacle) {
  const std::string& file = obstacle.file;
  Mesh mesh = read_mesh_from(FilePath::in(obstacle.folder, file));
  const Simplices simplices = cut_into_simplices(mesh);
  if (simplices.dimension != 2)
    throw InputError(file, "is not a surface", "an obstacle is a closed surface of triangles");
  std::vector<std::array<int, 3>> triangles(simplices.vertices.size() / 3);
  for (std::size_t i = 0; i < simplices.vertices.size(); ++i) triangles[i / 3][i % 3] = simplices.vertices[i];
  return {std::move(mesh.points), std::move(triangles)};
}

/// A point on the profile of a surface of revolution: distance from the axis, height along the axis.
struct ProfilePoint {
  double radius, height;
};

/// Appends the points of an arc about the origin between two angles from the axis.
void append_arc(double radius, double from, double to, std::vector<ProfilePoint>& profile) {
  constexpr int kSteps = 48;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = from + (to - from) * i / kSteps;
    profile.push_back({radius * std::sin(angle), radius * std::cos(angle)});
  }
}

std::vector<ProfilePoint> profile_of(const ScenarioObstacle& obstacle, double extent) {
  std::vector<ProfilePoint> profile;
  if (obstacle.kind == Kind::half_space) {
    profile = {{0.0, 0.0}, {extent, 0.0}};
  } else if (obstacle.kind == Kind::sphere) {
    append_arc(obstacle.radius, 0.0, std::numbers::pi, profile);
  } else {
    // the profile follows the inside, the rim and the outside
    const double half = 0.5 * obstacle.thickness;
    const double opening = kRadiansPerDegree * obstacle.opening;
    append_arc(obstacle.radius - half, std::numbers::pi, opening, profile);
    constexpr int kRim = 8;
    const double sine = std::sin(opening);
    const double cosine = std::cos(opening);
    for (int i = 1; i < kRim; ++i) {
      const double angle = std::numbers::pi * i / kRim;
      const double outwards = obstacle.radius - half * std::cos(angle);
      const double beyond = half * std::sin(angle);
      profile.push_back({outwards * sine - beyond * cosine, outwards * cosine + beyond * sine});
    }
    append_arc(obstacle.radius + half, opening, std::numbers::pi, profile);
  }
  return profile;
}

/// Returns the axis and two directions across it, an orthonormal frame.
std::array<Point, 3> frame_about(const Point& axis) {
  const auto scaled = [](Point v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    for (double& x : v) x /= length;
    return v;
  };
  const Point along = scaled(axis);
  const Point other = std::abs(along[0]) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0};
  const Point across = scaled(cross(along, other));
  return {along, across, cross(along, across)};
}

/// Appends the surface that a profile sweeps about an axis through `center`.
void append_revolution(const std::vector<ProfilePoint>& profile, const Point& center, const Point& axis,
                       Mesh& mesh) {
  const auto [along, across, third] = frame_about(axis);
  const Index first = mesh.vertex_count();
  for (const ProfilePoint& at : profile) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kAround;
      Point point = center;
      for (int c = 0; c < 3; ++c) {
        point[c] +=
            at.height * along[c] + at.radius * (std::cos(angle) * across[c] + std::sin(angle) * third[c]);
      }
      mesh.points.push_back(point);
    }
  }
  for (Index row = first; row + 2 * kAround <= mesh.vertex_count(); row += kAround) {
    for (Index i = 0; i < kAround; ++i) {
      const Index next = (i + 1) % kAround;
      mesh.cells.push_back(Shape::triangle, std::array{row + i, row + kAround + i, row + kAround + next});
      mesh.cells.push_back(Shape::triangle, std::array{row + i, row + kAround + next, row + next});
    }
  }
}

}  // namespace

std::shared_ptr<const Obstacle> obstacle_of(const ScenarioObstacle& obstacle) {
  switch (obstacle.kind) {
    case Kind::half_space:
      return half_space(obstacle.place, obstacle.direction);
    case Kind::sphere:
      return sphere(obstacle.place, obstacle.radius);
    case Kind::bowl:
      return bowl(obstacle.place, obstacle.direction, obstacle.radius, obstacle.thickness,
                  kRadiansPerDegree * obstacle.opening);
    case Kind::surface:
      break;
  }
  auto [points, triangles] = read_surface(obstacle);
  try {
    return closed_surface(std::move(points), std::move(triangles));
  } catch (const InvalidArgument& error) {
    throw InputError(obstacle.file, error.what(), "an obstacle is a closed surface of triangles");
  }
}

Mesh surfaces_of(std::span<const ScenarioObstacle> obstacles, double extent) {
  Mesh mesh;
  std::vector<std::int32_t> numbers;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const ScenarioObstacle& obstacle = obstacles[i];
    if (obstacle.kind == Kind::surface) {
      const auto [points, triangles] = read_surface(obstacle);
      const Index first = mesh.vertex_count();
      mesh.points.insert(mesh.points.end(), points.begin(), points.end());
      for (const auto& [a, b, c] : triangles)
        mesh.cells.push_back(Shape::triangle, std::array{first + a, first + b, first + c});
    } else {
      const Point axis = obstacle.kind == Kind::sphere ? Point{0, 1, 0} : obstacle.direction;
      append_revolution(profile_of(obstacle, extent), obstacle.place, axis, mesh);
    }
    numbers.resize(mesh.cells.shapes.size(), static_cast<std::int32_t>(i));
  }
  mesh.data.push_back({"obstacle", Association::cells, 1, std::move(numbers), {}, {}});
  return mesh;
}

}  // namespace meshorder
