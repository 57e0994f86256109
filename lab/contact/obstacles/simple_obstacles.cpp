// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Obstacles with a simple formula for the distance: the half-space and the sphere.
#include "base/point.hpp"
#include "lab/contact/obstacles/obstacle.hpp"
#include <meshorder/error.hpp>

namespace meshorder {
namespace {

class HalfSpace : public Obstacle {
 public:
  HalfSpace(const Point& point, const Point& normal) : normal_(normal), offset_(dot(point, normal)) {}

  [[nodiscard]] std::optional<SurfacePoint> nearest(const Point& x, const Point& /*from*/,
                                                    double reach) const override {
    const double d = distance(x);
    if (!(d <= reach)) return std::nullopt;
    return SurfacePoint{plus_scaled(x, -d, normal_), normal_, d};
  }
  [[nodiscard]] double distance(const Point& x) const override { return dot(normal_, x) - offset_; }

 private:
  Point normal_;
  double offset_;
};

class Sphere : public Obstacle {
 public:
  Sphere(const Point& center, double radius) : center_(center), radius_(radius) {}

  [[nodiscard]] std::optional<SurfacePoint> nearest(const Point& x, const Point& from,
                                                    double reach) const override {
    const Point out = minus(x, center_);
    const Point out_before = minus(from, center_);
    // past the centre the nearest point is on the other side
    if (dot(out, out_before) < 0.0) {
      if (const std::optional<Point> way = way_in(out_before, out)) {
        const Point at = plus_scaled(center_, radius_, *way);
        return SurfacePoint{at, *way, dot(*way, minus(x, at))};
      }
    }
    const double length = norm(out);
    const double d = length - radius_;
    if (!(d <= reach)) return std::nullopt;
    // at the centre all directions are equivalent
    const Point normal = length > 0.0 ? scaled(1.0 / length, out) : Point{0.0, 0.0, 1.0};
    return SurfacePoint{plus_scaled(center_, radius_, normal), normal, d};
  }
  [[nodiscard]] double distance(const Point& x) const override { return norm(minus(x, center_)) - radius_; }

 private:
  /// Returns the direction from the centre to the point where the segment from `a` to `b` enters the sphere;
  /// nothing if the segment misses the sphere. `a` and `b` are relative to the centre and on opposite sides
  /// of the centre.
  [[nodiscard]] std::optional<Point> way_in(const Point& a, const Point& b) const {
    const Point step = minus(b, a);
    const double length = norm(step);
    const Point direction = scaled(1.0 / length, step);
    const double along = -dot(a, direction);  // to the point nearest to the centre
    const double aside = norm(plus_scaled(a, along, direction));
    if (!(aside < radius_)) return std::nullopt;
    const double entry = along - std::sqrt((radius_ - aside) * (radius_ + aside));
    const Point place = entry > 0.0 ? plus_scaled(a, entry, direction) : a;
    const double out = norm(place);
    if (out > 0.0) return scaled(1.0 / out, place);
    return std::nullopt;
  }

  Point center_;
  double radius_;
};

}  // namespace

std::unique_ptr<Obstacle> half_space(const Point& point, const Point& normal) {
  const double length = norm(normal);
  if (!is_finite(point) || !std::isfinite(length) || length == 0.0)
    throw InvalidArgument("half_space: point and normal must be finite and the normal not 0");
  return std::make_unique<HalfSpace>(point, scaled(1.0 / length, normal));
}

std::unique_ptr<Obstacle> sphere(const Point& center, double radius) {
  if (!is_finite(center) || !std::isfinite(radius) || radius <= 0.0)
    throw InvalidArgument("sphere: center and radius must be finite and the radius positive");
  return std::make_unique<Sphere>(center, radius);
}

}  // namespace meshorder
