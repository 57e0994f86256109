// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/random.hpp"
#include "lab/implicit/backward_euler.hpp"

#include <Eigen/Dense>

#include <array>
#include <vector>

namespace meshorder::test {

/// A body and its points at rest.
struct BodyAtRest {
  std::vector<Point> points;
  Body body;
};

inline constexpr double kYoung = 1e5;
inline constexpr double kPoisson = 0.3;
inline constexpr double kDensity = 1000;

/// A box at the origin, of cubes that are each cut into six tetrahedra around a diagonal.
inline BodyAtRest box(std::array<Index, 3> cubes, Point lengths, MaterialModel model) {
  BodyAtRest result;
  const auto vertex = [&](Index i, Index j, Index k) {
    return (i * (cubes[1] + 1) + j) * (cubes[2] + 1) + k;
  };
  for (Index i = 0; i <= cubes[0]; ++i) {
    for (Index j = 0; j <= cubes[1]; ++j) {
      for (Index k = 0; k <= cubes[2]; ++k) {
        result.points.push_back(
            {lengths[0] * i / cubes[0], lengths[1] * j / cubes[1], lengths[2] * k / cubes[2]});
      }
    }
  }
  constexpr std::array<std::array<int, 3>, 6> kPaths{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  Simplices& simplices = result.body.simplices;
  simplices.dimension = 3;
  for (Index i = 0; i < cubes[0]; ++i) {
    for (Index j = 0; j < cubes[1]; ++j) {
      for (Index k = 0; k < cubes[2]; ++k) {
        for (const auto& path : kPaths) {
          std::array<Index, 3> at{i, j, k};
          simplices.vertices.push_back(vertex(at[0], at[1], at[2]));
          for (const int axis : path) {
            ++at[axis];
            simplices.vertices.push_back(vertex(at[0], at[1], at[2]));
          }
        }
      }
    }
  }
  result.body.elasticity.model = model;
  result.body.elasticity.lame = Lame::from_young(kYoung, kPoisson);
  result.body.densities = {kDensity};
  return result;
}

/// A state off the body's rest, with velocities: up to `amplitude` metres and metres per second.
inline MotionState disturbed(const std::vector<Point>& points, double amplitude, std::uint64_t seed = 1) {
  Random random(seed);
  MotionState state;
  state.positions = points;
  state.velocities.resize(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      state.positions[v][c] += amplitude * (2 * random.unit() - 1);
      state.velocities[v][c] = amplitude * (2 * random.unit() - 1);
    }
  }
  return state;
}

inline Eigen::VectorXd flat(const std::vector<Point>& points) {
  Eigen::VectorXd result(3 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t v = 0; v < points.size(); ++v) {
    for (int c = 0; c < 3; ++c) result(static_cast<Eigen::Index>(3 * v) + c) = points[v][c];
  }
  return result;
}

}  // namespace meshorder::test
