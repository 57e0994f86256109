// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "base/polymorphic.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace meshorder {

/// The nearest point on an obstacle's surface.
struct SurfacePoint {
  Point at{};
  Point normal{};         ///< of length 1, out of the obstacle
  double distance = 0.0;  ///< signed: negative inside
};

/// A rigid body at rest that the simulated body must stay outside of. Immutable; all functions are
/// thread-safe.
class Obstacle : public Polymorphic {
 public:
  /// Returns the point of the surface nearest to the vertex at `x`, if the vertex is within `reach` (m) of
  /// the surface or inside. The vertex was at `from`, outside, when the step began. If the vertex has passed
  /// through a thin wall, the returned point is on the side of the wall that the vertex came from, and
  /// `distance` is negative.
  [[nodiscard]] virtual std::optional<SurfacePoint> nearest(const Point& x, const Point& from,
                                                            double reach) const = 0;

  /// Returns only the signed distance of x, m.
  [[nodiscard]] virtual double distance(const Point& x) const = 0;
};

/// Returns the half-space below a plane: normal · (x − point) < 0.
std::unique_ptr<Obstacle> half_space(const Point& point, const Point& normal);
std::unique_ptr<Obstacle> sphere(const Point& center, double radius);
/// Returns a spherical shell of the given thickness, whose middle surface has the radius `radius`. A cone
/// around +axis with the half angle `opening` (radians, 0 … π) cuts the shell open; the rim is rounded. The
/// axis need not have length 1.
std::unique_ptr<Obstacle> bowl(const Point& center, const Point& axis, double radius, double thickness,
                               double opening);
/// Returns the solid that a closed surface encloses, by signed distance to its triangles; `triangles` turn
/// counterclockwise seen from outside. Throws InvalidArgument, naming an edge, triangle or point, unless the
/// surface is closed, oriented and finite.
std::unique_ptr<Obstacle> closed_surface(std::vector<Point> points,
                                         std::vector<std::array<int, 3>> triangles);

}  // namespace meshorder
