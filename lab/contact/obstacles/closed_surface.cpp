// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Bærentzen, Aanæs: Signed Distance Computation Using the Angle Weighted Pseudonormal (2005).
#include "base/point.hpp"
#include "lab/contact/geometry/box_tree.hpp"
#include "lab/contact/geometry/simplex_point.hpp"
#include "lab/contact/obstacles/obstacle.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

using Triangle = std::array<int, 3>;

Point unit_or_zero(const Point& a) {
  const double length = norm(a);
  return length > 0.0 ? scaled(1.0 / length, a) : Point{};
}

/// The edge of `triangle` from its corner k to the next corner.
struct HalfEdge {
  int from = 0;
  int to = 0;
  int triangle = 0;
  int k = 0;
};

/// Returns the half-edges, sorted by their two ends. Throws InvalidArgument if a half-edge has two equal
/// ends, or not exactly one opposite half-edge.
std::vector<HalfEdge> matched_half_edges(std::span<const Triangle> triangles) {
  const auto ends = [](const HalfEdge& half_edge) { return std::pair(half_edge.from, half_edge.to); };
  std::vector<HalfEdge> half_edges;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k)
      half_edges.push_back({triangles[t][k], triangles[t][(k + 1) % 3], static_cast<int>(t), k});
  }
  std::sort(half_edges.begin(), half_edges.end(),
            [&](const HalfEdge& a, const HalfEdge& b) { return ends(a) < ends(b); });
  for (std::size_t i = 0; i < half_edges.size(); ++i) {
    const HalfEdge& half_edge = half_edges[i];
    if (half_edge.from == half_edge.to) {
      throw InvalidArgument(
          fmt::format("closed_surface: triangle {} has point {} at two corners (counted from 0)",
                      half_edge.triangle, half_edge.from));
    }
    if (i + 1 < half_edges.size() && ends(half_edges[i + 1]) == ends(half_edge)) {
      throw InvalidArgument(
          fmt::format("closed_surface: more than one triangle has the edge from point {} to point {} "
                      "(counted from 0); two triangles must meet at each edge and turn the same way",
                      half_edge.from, half_edge.to));
    }
    const auto opposite =
        std::lower_bound(half_edges.begin(), half_edges.end(), std::pair(half_edge.to, half_edge.from),
                         [&](const HalfEdge& a, const std::pair<int, int>& key) { return ends(a) < key; });
    if (opposite == half_edges.end() || ends(*opposite) != std::pair(half_edge.to, half_edge.from)) {
      throw InvalidArgument(
          fmt::format("closed_surface: only one triangle has the edge between points {} and {} (counted from "
                      "0); the surface must be closed",
                      half_edge.from, half_edge.to));
    }
  }
  return half_edges;
}

class ClosedSurface : public Obstacle {
 public:
  ClosedSurface(std::vector<Point> points, std::vector<Triangle> triangles)
      : points_(std::move(points)), triangles_(std::move(triangles)), tree_(boxes(points_, triangles_)) {
    const std::vector<HalfEdge> half_edges = matched_half_edges(triangles_);
    find_normals(half_edges);
    Box all;
    double volume = 0.0;
    for (const Triangle& t : triangles_) {
      for (const int corner : t) all.include(points_[corner]);
    }
    const Point& origin = points_[triangles_.front()[0]];
    for (const Triangle& t : triangles_) {
      volume += dot(minus(points_[t[0]], origin),
                    cross(minus(points_[t[1]], origin), minus(points_[t[2]], origin)));
    }
    if (!(volume > 0.0)) {
      throw InvalidArgument(fmt::format(
          "closed_surface: the triangle with the edge from point {} to point {} (counted from 0), and with "
          "it the surface as a whole, is inside out; triangles must turn counterclockwise seen from outside",
          triangles_.front()[0], triangles_.front()[1]));
    }
    touching_ = 1e-9 * norm(minus(all.upper, all.lower));
  }

  [[nodiscard]] std::optional<SurfacePoint> nearest(const Point& x, const Point& from,
                                                    double reach) const override {
    if (!is_finite(x)) return std::nullopt;
    const SurfacePoint natural = nearest_point(x);
    if (natural.distance <= norm(minus(x, from))) {
      if (const std::optional<SurfacePoint> behind = back_through_surface(x, from, natural)) return behind;
    }
    if (!(natural.distance <= reach)) return std::nullopt;
    return natural;
  }

  [[nodiscard]] double distance(const Point& x) const override {
    return is_finite(x) ? nearest_point(x).distance : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  struct Crossing {
    double part = 0.0;  // share of the way from a to b
    int triangle = -1;
    bool in = false;
  };

  static std::vector<Box> boxes(const std::vector<Point>& points, const std::vector<Triangle>& triangles) {
    if (triangles.empty()) throw InvalidArgument("closed_surface: there are no triangles");
    std::vector<Box> result(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (const int corner : triangles[t]) {
        if (corner < 0 || corner >= static_cast<int>(points.size()))
          throw InvalidArgument(
              fmt::format("closed_surface: triangle {} names point {}, but points are 0 to {}", t, corner,
                          static_cast<std::int64_t>(points.size()) - 1));
        if (!is_finite(points[corner]))
          throw InvalidArgument(fmt::format("closed_surface: point {} is not finite", corner));
        result[t].include(points[corner]);
      }
    }
    return result;
  }

  /// Computes the normals that decide signs: of faces, edges (sum of two faces), corners (weighted by angle).
  void find_normals(std::span<const HalfEdge> half_edges) {
    face_normals_.resize(triangles_.size());
    edge_normals_.resize(triangles_.size());
    corner_normals_.resize(points_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Triangle& corners = triangles_[t];
      const Point& a = points_[corners[0]];
      face_normals_[t] = unit_or_zero(cross(minus(points_[corners[1]], a), minus(points_[corners[2]], a)));
      for (int k = 0; k < 3; ++k) {
        const Point to = unit_or_zero(minus(points_[corners[(k + 1) % 3]], points_[corners[k]]));
        const Point back = unit_or_zero(minus(points_[corners[(k + 2) % 3]], points_[corners[k]]));
        const double angle = std::atan2(norm(cross(to, back)), dot(to, back));
        Point& normal = corner_normals_[corners[k]];
        normal = plus_scaled(normal, angle, face_normals_[t]);
      }
    }
    for (const HalfEdge& half_edge : half_edges) {
      const auto opposite = std::lower_bound(half_edges.begin(), half_edges.end(), half_edge,
                                             [](const HalfEdge& a, const HalfEdge& key) {
                                               return std::pair(a.from, a.to) < std::pair(key.to, key.from);
                                             });
      edge_normals_[half_edge.triangle][half_edge.k] = unit_or_zero(
          plus_scaled(face_normals_[half_edge.triangle], 1.0, face_normals_[opposite->triangle]));
    }
    for (Point& normal : corner_normals_) normal = unit_or_zero(normal);
  }

  [[nodiscard]] const Point& pseudonormal(int triangle, TrianglePoint::On on) const {
    if (on == TrianglePoint::On::face) return face_normals_[triangle];
    const int number = static_cast<int>(on);
    return number < 3 ? corner_normals_[triangles_[triangle][number]] : edge_normals_[triangle][number - 3];
  }

  [[nodiscard]] SurfacePoint nearest_point(const Point& x) const {
    TrianglePoint best;
    best.squared_distance = std::numeric_limits<double>::infinity();
    int triangle = 0;
    tree_.visit_nearest(x, [&](int t) {
      const Triangle& corners = triangles_[t];
      const TrianglePoint here =
          nearest_on_triangle(x, points_[corners[0]], points_[corners[1]], points_[corners[2]]);
      // of equally near triangles, takes the one with the lowest number, whatever the path through the tree
      if (here.squared_distance < best.squared_distance ||
          (here.squared_distance == best.squared_distance && t < triangle)) {
        best = here;
        triangle = t;
      }
      return best.squared_distance;
    });
    const Point& normal = pseudonormal(triangle, best.on);
    const Point way = minus(x, best.at);
    const double length = std::sqrt(best.squared_distance);
    const double sign = dot(way, normal) >= 0.0 ? 1.0 : -1.0;
    // a length that may be a rounding error gives no direction
    if (best.on == TrianglePoint::On::face || length <= touching_) return {best.at, normal, sign * length};
    return {best.at, scaled(sign / length, way), sign * length};
  }

  /// Returns the crossings of the segment from a to b, the nearest to a first.
  [[nodiscard]] std::vector<Crossing> crossings(const Point& a, const Point& b) const {
    std::vector<Crossing> result;
    const Point way = minus(b, a);
    tree_.visit_on_segment(a, b, [&](int t) {
      const std::array<Point, 3> corner{minus(points_[triangles_[t][0]], a),
                                        minus(points_[triangles_[t][1]], a),
                                        minus(points_[triangles_[t][2]], a)};
      std::array<double, 3> around{};  // volumes, whose signs say on which side of each edge the line passes
      for (int k = 0; k < 3; ++k) around[k] = dot(way, cross(corner[k], corner[(k + 1) % 3]));
      const bool in = around[0] <= 0.0 && around[1] <= 0.0 && around[2] <= 0.0;
      const bool out = around[0] >= 0.0 && around[1] >= 0.0 && around[2] >= 0.0;
      const double along = dot(way, face_normals_[t]);
      if (in == out || along == 0.0) return;
      const double part = dot(corner[0], face_normals_[t]) / along;
      if (part >= 0.0 && part <= 1.0) result.push_back({part, t, in});
    });
    std::sort(result.begin(), result.end(), [](const Crossing& p, const Crossing& q) {
      return p.part < q.part || (p.part == q.part && p.triangle < q.triangle);
    });
    return result;
  }

  /// Returns where the path from `from` to x enters the body, if `from` is outside and x either has left the
  /// body again or is so deep that `natural`, its nearest surface point, is on another side.
  [[nodiscard]] std::optional<SurfacePoint> back_through_surface(const Point& x, const Point& from,
                                                                 const SurfacePoint& natural) const {
    Point start = from;
    const double moved = norm(minus(x, from));
    const SurfacePoint before = nearest_point(from);
    if (before.distance > moved) return std::nullopt;
    // a vertex that rests on the surface may have been inside by less than the tolerance
    if (before.distance <= touching_) {
      if (-before.distance > moved) return std::nullopt;
      start = plus_scaled(before.at, std::max(-before.distance, touching_), before.normal);
    }
    const std::vector<Crossing> on_the_way = crossings(start, x);
    const auto entry =
        std::find_if(on_the_way.begin(), on_the_way.end(), [](const Crossing& c) { return c.in; });
    if (entry == on_the_way.end()) return std::nullopt;
    const Point& normal = face_normals_[entry->triangle];
    const Point way = minus(x, start);
    if (natural.distance > 0.0) {
      // x is outside again; but a path along the surface may go in and out by rounding errors
      const auto exit = std::find_if(entry, on_the_way.end(), [](const Crossing& c) { return !c.in; });
      const double middle = 0.5 * (entry->part + (exit == on_the_way.end() ? 1.0 : exit->part));
      if (!(nearest_point(plus_scaled(start, middle, way)).distance < -touching_)) return std::nullopt;
    } else if (!(dot(natural.normal, normal) < 0.0 && dot(natural.normal, minus(start, natural.at)) < 0.0)) {
      return std::nullopt;
    }
    const Point at = plus_scaled(start, entry->part, way);
    return SurfacePoint{at, normal, dot(normal, minus(x, at))};
  }

  std::vector<Point> points_;
  std::vector<Triangle> triangles_;
  BoxTree tree_;
  std::vector<Point> face_normals_;
  std::vector<std::array<Point, 3>> edge_normals_;
  std::vector<Point> corner_normals_;
  double touching_ = 0.0;  // distances up to this may be rounding errors
};

}  // namespace

std::unique_ptr<Obstacle> closed_surface(std::vector<Point> points,
                                         std::vector<std::array<int, 3>> triangles) {
  return std::make_unique<ClosedSurface>(std::move(points), std::move(triangles));
}

}  // namespace meshorder
