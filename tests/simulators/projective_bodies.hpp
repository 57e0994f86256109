// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "bodies.hpp"
#include "lab/admm/projective_dynamics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace meshorder::test {

inline constexpr std::array kLocalLaws{LocalModel::springs, LocalModel::strain, LocalModel::stvk,
                                       LocalModel::neo_hookean, LocalModel::log_neo_hookean};

struct ProjectiveAtRest {
  std::vector<Point> points;
  ProjectiveBody body;
};

/// The box of `box`, with a stiffness of about kYoung for every law.
inline ProjectiveAtRest projective_box(std::array<Index, 3> cubes, Point lengths, LocalModel model) {
  BodyAtRest plain = box(cubes, lengths, MaterialModel::neo_hookean);
  ProjectiveAtRest result;
  result.points = std::move(plain.points);
  result.body.simplices = std::move(plain.body.simplices);
  result.body.densities = {kDensity};
  result.body.law.model = model;
  result.body.law.stiffness = model == LocalModel::springs ? kYoung * lengths[0] / cubes[0] : kYoung;
  result.body.law.lame = Lame::from_young(kYoung, kPoisson);
  return result;
}

/// The same body with vertex v renumbered to place[v], and with its simplices in another order.
inline ProjectiveAtRest renumbered(const ProjectiveAtRest& from, const std::vector<Index>& place) {
  ProjectiveAtRest result = from;
  for (std::size_t v = 0; v < place.size(); ++v) result.points[place[v]] = from.points[v];
  const Offset count = from.body.simplices.size();
  EXPECT_NE(count % 7, 0);
  for (Offset s = 0; s < count; ++s) {
    for (int a = 0; a < 4; ++a) {
      result.body.simplices.vertices[4 * ((s * 7) % count) + a] =
          place[from.body.simplices.vertices[4 * s + a]];
    }
  }
  return result;
}

inline MotionState renumbered(const MotionState& from, const std::vector<Index>& place) {
  MotionState result = from;
  for (std::size_t v = 0; v < place.size(); ++v) {
    result.positions[place[v]] = from.positions[v];
    result.velocities[place[v]] = from.velocities[v];
  }
  return result;
}

inline void run(Integrator& integrator, int steps) {
  for (int i = 0; i < steps; ++i) {
    const StepReport report = integrator.step();
    ASSERT_TRUE(report.warnings.empty()) << report.warnings.front();
  }
}

inline void expect_same(const std::vector<Point>& actual, const std::vector<Point>& expected,
                        double tolerance, const std::string& what = "") {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t v = 0; v < actual.size(); ++v) {
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(actual[v][c], expected[v][c], tolerance) << what << " vertex " << v;
  }
}

inline double total(const Balance& balance) { return balance.kinetic + balance.elastic + balance.potential; }

}  // namespace meshorder::test
