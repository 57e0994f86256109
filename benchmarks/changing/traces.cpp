// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "benchmarks/changing/traces.hpp"

#include "base/random.hpp"
#include "lab/fluid/alpha_shape.hpp"
#include "lab/fluid/fluid.hpp"
#include "lab/scenario/scenario.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace meshorder {
namespace {

constexpr double kJitter = 0.3;  // in spacings

/// Returns the number of cells along an edge of a cube of about `count` cells.
Index along_edge(Index count) { return static_cast<Index>(std::lround(std::cbrt(count))); }

/// Returns a point near the middle of each cell of a lattice in the unit cube.
std::vector<Point> jittered_lattice(Index edge, Random& random) {
  std::vector<Point> points;
  const double spacing = 1.0 / edge;
  for (Index i = 0; i < edge; ++i) {
    for (Index j = 0; j < edge; ++j) {
      for (Index k = 0; k < edge; ++k) {
        Point& point = points.emplace_back();
        const std::array cell{i, j, k};
        for (int axis = 0; axis < 3; ++axis)
          point[axis] = (cell[axis] + 0.5 + kJitter * (2 * random.unit() - 1)) * spacing;
      }
    }
  }
  return points;
}

/// Base of the traces in the unit cube.
class InCube : public Trace {
 protected:
  explicit InCube(Index count)
      : random_(1),
        points_(jittered_lattice(along_edge(count), random_)),
        spacing_(1.0 / along_edge(count)) {}

  /// Returns the corners of the Delaunay tetrahedra, without the thin ones along the cube's faces.
  [[nodiscard]] std::vector<Index> corners(const std::vector<Point>& points) const {
    constexpr double kHoles = 1.5;
    const std::vector<Walls> walls(points.size(), kNoWalls);
    return alpha_shape(triangulate_(points), points, walls, kHoles * spacing_).corners;
  }

  Random random_;
  std::vector<Point> points_;
  double spacing_;
  Index step_ = 0;

 private:
  Triangulate triangulate_ = delaunay_program();
};

class Stir : public InCube {
 public:
  Stir(Index count, double share_replaced) : InCube(count), share_replaced_(share_replaced) {}

  TraceStep next() override {
    TraceStep result;
    if (step_++ > 0) {
      move();
      replace(result);
    }
    result.points = points_;
    result.corners = corners(points_);
    return result;
  }

 private:
  /// Moves the points by the velocity of Taylor–Green rolls, at most 1.
  void move() {
    constexpr double kCourant = 0.3;
    constexpr double kPi = std::numbers::pi;
    for (auto& [x, y, z] : points_) {
      const double u = std::sin(kPi * x) * std::cos(2 * kPi * y);
      const double v = -0.5 * std::cos(kPi * x) * std::sin(2 * kPi * y);
      const double w = 0.3 * std::sin(2 * kPi * z) * std::cos(step_ / 5.0);
      x += kCourant * spacing_ * u;
      y += kCourant * spacing_ * v;
      z += kCourant * spacing_ * w;
    }
  }

  void replace(TraceStep& result) {
    const auto replaced =
        static_cast<Index>(std::lround(share_replaced_ * static_cast<double>(points_.size())));
    if (replaced == 0) return;
    result.previous.resize(points_.size());
    std::iota(result.previous.begin(), result.previous.end(), Index{0});
    for (Index k = 0; k < replaced; ++k) {
      const std::uint64_t v = random_.below(points_.size());
      for (double& x : points_[v]) x = random_.unit();
      result.previous[v] = -1;
    }
  }

  double share_replaced_;
};

class Refine : public InCube {
 public:
  explicit Refine(Index count)
      : InCube(count), candidates_(jittered_lattice(2 * along_edge(count), random_)) {}

  TraceStep next() override {
    constexpr double kRadius = 0.15;
    const double turned = step_ / 20.0;
    const Point middle{0.5 + 0.3 * std::cos(turned), 0.5 + 0.3 * std::sin(turned), 0.5};
    const auto is_inside = [&](Index candidate) {
      double squared = 0;
      for (int axis = 0; axis < 3; ++axis)
        squared += std::pow(candidates_[static_cast<std::size_t>(candidate)][axis] - middle[axis], 2);
      return squared < kRadius * kRadius;
    };
    const auto lattice = static_cast<Index>(points_.size());
    TraceStep result;
    result.successors.resize(points_.size() + inside_.size(), -1);
    std::iota(result.successors.begin(), result.successors.begin() + lattice, Index{0});
    result.previous = {result.successors.begin(), result.successors.begin() + lattice};
    std::vector<Index> now;
    std::vector<bool> was(candidates_.size());
    for (std::size_t k = 0; k < inside_.size(); ++k) {
      was[static_cast<std::size_t>(inside_[k])] = true;
      if (!is_inside(inside_[k])) continue;
      result.successors[points_.size() + k] = static_cast<Index>(result.previous.size());
      result.previous.push_back(static_cast<Index>(points_.size() + k));
      now.push_back(inside_[k]);
    }
    for (Index candidate = 0; candidate < index_size(candidates_); ++candidate) {
      if (was[static_cast<std::size_t>(candidate)] || !is_inside(candidate)) continue;
      result.previous.push_back(-1);
      now.push_back(candidate);
    }
    inside_ = std::move(now);
    if (step_++ == 0) {
      result.previous.clear();
      result.successors.clear();
    }
    result.points = points_;
    for (const Index candidate : inside_)
      result.points.push_back(candidates_[static_cast<std::size_t>(candidate)]);
    result.corners = corners(result.points);
    return result;
  }

 private:
  std::vector<Point> candidates_;
  std::vector<Index> inside_;  ///< indices of the candidates in the ball
};

class Cut : public InCube {
 public:
  Cut(Index count, Index steps) : InCube(count), steps_(steps), corners_(corners(points_)) {}

  TraceStep next() override {
    const double reach = 0.9 * step_++ / steps_;
    TraceStep result{.points = points_};
    for (std::size_t t = 0; t < corners_.size(); t += 4) {
      bool below = false;
      bool above = false;
      bool reached = true;
      for (std::size_t c = t; c < t + 4; ++c) {
        const Point& point = points_[static_cast<std::size_t>(corners_[c])];
        (point[1] < 0.5 ? below : above) = true;
        reached = reached && point[0] < reach;
      }
      if (below && above && reached) continue;
      for (std::size_t c = t; c < t + 4; ++c) result.corners.push_back(corners_[c]);
    }
    return result;
  }

 private:
  Index steps_;
  std::vector<Index> corners_;
};

class Dam : public Trace {
 public:
  explicit Dam(Index count) : fluid_(options(count), {"original", "original"}, delaunay_program()) {}

  TraceStep next() override {
    (void)fluid_.step();
    return {.points = fluid_.state().positions, .corners = fluid_.mesh().corners};
  }

 private:
  static FluidOptions options(Index count) {
    FluidOptions result = find_scenario("splash").fluid();
    const Point& column = result.column;
    result.spacing = std::cbrt(column[0] * column[1] * column[2] / count);
    return result;
  }

  Fluid fluid_;
};

}  // namespace

std::unique_ptr<Trace> make_trace(const std::string& name, Index count, Index steps) {
  constexpr double kReplaced = 0.02;
  if (name == "stir") return std::make_unique<Stir>(count, 0);
  if (name == "churn") return std::make_unique<Stir>(count, kReplaced);
  if (name == "refine") return std::make_unique<Refine>(count);
  if (name == "cut") return std::make_unique<Cut>(count, steps);
  if (name == "dam") return std::make_unique<Dam>(count);
  throw std::invalid_argument("unknown trace '" + name + "'; known: stir, churn, refine, cut and dam");
}

}  // namespace meshorder
