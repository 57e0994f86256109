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
  /// Returns the nearest point of the surface if it is within `reach` (m) of the vertex at `x`, or if x is
  /// inside. The vertex was at `from`, outside, when the step began. If it has passed through a thin wall
  /// since, the returned point is on the side of the wall that the vertex came from, and `distance` is
  /// negative.
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
/// counterclockwise seen from outside. Throws InvalidArgument, which names an edge, for a surface that is not
/// closed and oriented.
std::unique_ptr<Obstacle> closed_surface(std::vector<Point> points,
                                         std::vector<std::array<int, 3>> triangles);

}  // namespace meshorder
