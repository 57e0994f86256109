// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/point.hpp"
#include "lab/contact/obstacles/obstacle.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <numbers>

namespace meshorder {
namespace {

/// All points within half the thickness of a surface, "the middle": the part of a sphere whose directions
/// from the centre make angles of at least `opening` with the axis. Private functions take points relative to
/// the centre.
class Bowl : public Obstacle {
 public:
  Bowl(const Point& center, const Point& axis, double radius, double thickness, double opening)
      : center_(center),
        axis_(axis),
        radius_(radius),
        half_thickness_(0.5 * thickness),
        cos_opening_(std::cos(opening)),
        sin_opening_(std::sin(opening)) {}

  [[nodiscard]] std::optional<SurfacePoint> nearest(const Point& x, const Point& from,
                                                    double reach) const override {
    const Point p = minus(x, center_);
    if (const std::optional<SurfacePoint> behind = back_through_wall(p, minus(from, center_))) return behind;
    const Point middle = nearest_of_middle(p);
    const Point way = minus(p, middle);
    const double length = norm(way);
    const double d = length - half_thickness_;
    if (!(d <= reach)) return std::nullopt;
    // in the middle of the wall both sides are equally near
    const Point normal =
        length > 0.0 ? scaled(1.0 / length, way) : scaled(side_of(minus(from, center_)) / radius_, middle);
    return SurfacePoint{plus_scaled(center_, 1.0, plus_scaled(middle, half_thickness_, normal)), normal, d};
  }

  [[nodiscard]] double distance(const Point& x) const override {
    const Point p = minus(x, center_);
    return norm(minus(p, nearest_of_middle(p))) - half_thickness_;
  }

 private:
  /// Returns 1 outside of the middle's sphere, −1 within.
  [[nodiscard]] double side_of(const Point& p) const { return dot(p, p) >= radius_ * radius_ ? 1.0 : -1.0; }

  /// Returns whether the ray from the centre through p meets the middle; true for the centre itself.
  [[nodiscard]] bool faces_middle(const Point& p) const { return dot(p, axis_) <= cos_opening_ * norm(p); }

  [[nodiscard]] Point nearest_of_middle(const Point& p) const {
    const double length = norm(p);
    if (faces_middle(p)) return length > 0.0 ? scaled(radius_ / length, p) : scaled(-radius_, axis_);
    // the point of the middle's rim in the half-plane of p and the axis
    const Point aside = plus_scaled(p, -dot(p, axis_), axis_);
    const double off_axis = norm(aside);
    const Point sideways = off_axis > 0.0 ? scaled(1.0 / off_axis, aside) : across_axis();
    return plus_scaled(scaled(radius_ * cos_opening_, axis_), radius_ * sin_opening_, sideways);
  }

  [[nodiscard]] Point across_axis() const {
    const Point other = std::abs(axis_[0]) < 0.7 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0};
    const Point across = cross(axis_, other);
    return scaled(1.0 / norm(across), across);
  }

  /// Returns the surface point on the side of `a` to which p must go back; nothing unless the segment from
  /// `a` to p crosses the middle.
  [[nodiscard]] std::optional<SurfacePoint> back_through_wall(const Point& p, const Point& a) const {
    const std::optional<Point> crossing = first_crossing(a, p);
    if (!crossing) return std::nullopt;
    const double side = side_of(a);
    // straight back if p is beyond the wall, else towards the crossing
    const bool straight = side_of(p) != side && faces_middle(p) && dot(p, p) > 0.0;
    const Point& toward = straight ? p : *crossing;
    const Point normal = scaled(side / norm(toward), toward);
    const Point at = scaled(side * radius_ + half_thickness_, normal);
    return SurfacePoint{plus_scaled(center_, 1.0, at), normal, dot(normal, minus(p, at))};
  }

  /// Returns where the segment from `a` to `b` first crosses the middle. If an end is within the sphere, the
  /// sides of both ends alone decide whether the sphere is crossed: rounding errors do not.
  [[nodiscard]] std::optional<Point> first_crossing(const Point& a, const Point& b) const {
    const bool from_within = side_of(a) < 0.0;
    const bool to_within = side_of(b) < 0.0;
    const Point step = minus(b, a);
    const double square = dot(step, step);
    const double along = dot(a, step);
    const double discriminant = along * along - square * (dot(a, a) - radius_ * radius_);
    if (!(square > 0.0) || std::isnan(discriminant) || (from_within && to_within)) return std::nullopt;
    if (!from_within && !to_within && !(discriminant > 0.0 && -along > 0.0 && -along < square))
      return std::nullopt;
    const double root = std::sqrt(std::max(discriminant, 0.0));
    const Point entry = plus_scaled(a, std::clamp((-along - root) / square, 0.0, 1.0), step);
    if (!from_within && faces_middle(entry)) return entry;
    const Point exit = plus_scaled(a, std::clamp((-along + root) / square, 0.0, 1.0), step);
    if (!to_within && faces_middle(exit)) return exit;
    return std::nullopt;
  }

  Point center_;
  Point axis_;
  double radius_;
  double half_thickness_;
  double cos_opening_;
  double sin_opening_;
};

}  // namespace

std::unique_ptr<Obstacle> bowl(const Point& center, const Point& axis, double radius, double thickness,
                               double opening) {
  const double length = norm(axis);
  if (!is_finite(center) || !std::isfinite(length) || length == 0.0)
    throw InvalidArgument("bowl: center and axis must be finite and the axis not 0");
  if (!std::isfinite(radius) || !(thickness > 0.0) || !(thickness < 2.0 * radius))
    throw InvalidArgument(
        "bowl: radius and thickness must be positive and the wall thinner than twice the radius");
  if (!(opening >= 0.0 && opening <= std::numbers::pi))
    throw InvalidArgument("bowl: the opening must be an angle from 0 to pi");
  return std::make_unique<Bowl>(center, scaled(1.0 / length, axis), radius, thickness, opening);
}

}  // namespace meshorder
