// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/contact_finder.hpp"

#include "base/parallel.hpp"
#include "kernels/positions.hpp"
#include "lab/contact/search/body_surface.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <string>

namespace meshorder {
namespace {

/// Number of neighbouring vertices in a cluster: one distance can show that all are out of reach.
constexpr Index kInCluster = 64;

Contact contact_with(Index vertex, const SurfacePoint& place, double friction, std::int32_t obstacle) {
  Contact contact;
  contact.vertices[0] = vertex;
  contact.weights[0] = 1.0;
  contact.normal = place.normal;
  contact.offset = dot(place.normal, place.at);
  contact.friction = friction;
  contact.with = obstacle;
  return contact;
}

/// Returns whether an obstacle is out of reach of a box around some vertices and their earlier positions.
/// If so, no vertex is near the obstacle or went through it: a distance changes by at most the path length.
bool out_of_reach(const Obstacle& obstacle, const Box& box, double reach) {
  constexpr double kAboveRounding = 1.0 + 1e-9;
  const Point center = scaled(0.5, plus_scaled(box.lower, 1.0, box.upper));
  const double radius = 0.5 * norm(minus(box.upper, box.lower));
  return obstacle.distance(center) > kAboveRounding * (radius + reach);
}

/// Calls `visit(cluster)` for those of clusters begin … end − 1 that may be within reach of the obstacle.
/// Neighbouring clusters that are out of reach are skipped together.
template <class Visit>
void visit_within_reach(const Obstacle& obstacle, double reach, std::span<const Box> boxes, Index begin,
                        Index end, Visit visit) {
  Box box;
  for (const Box& part : boxes.subspan(begin, end - begin)) {
    box.include(part.lower);
    box.include(part.upper);
  }
  if (begin == end || out_of_reach(obstacle, box, reach)) return;
  if (end == begin + 1) return visit(begin);
  const Index middle = begin + (end - begin) / 2;
  visit_within_reach(obstacle, reach, boxes, begin, middle, visit);
  visit_within_reach(obstacle, reach, boxes, middle, end, visit);
}

}  // namespace

void ContactFinder::find_near(std::initializer_list<std::span<const double>> places, double reach) {
  for_each_chunk(index_size(surface_), kInCluster, [&](Index c, Index begin, Index end) {
    clusters_[c].near.clear();
    boxes_[c] = {};
    for (const std::span<const double> place : places) {
      for (Index i = begin; i < end; ++i) boxes_[c].include(point_of(place, surface_[i]));
    }
  });
  for (Index o = 0; o < index_size(options_.obstacles); ++o) {
    visit_within_reach(*options_.obstacles[o].obstacle, reach, boxes_, 0, index_size(clusters_),
                       [&](Index c) { clusters_[c].near.push_back(o); });
  }
}

void ContactFinder::check(std::span<const double> positions, const char* function) const {
  if (positions.size() != static_cast<std::size_t>(kPaddedStride) * static_cast<std::size_t>(vertex_count_))
    throw InvalidArgument(std::string(function) + ": positions must be those of all points at rest");
}

ContactFinder::ContactFinder(const Simplices& simplices, std::span<const Point> points,
                             ContactOptions options)
    : options_(std::move(options)), vertex_count_(index_size(points)) {
  if (!(options_.reach >= 0.0)) throw InvalidArgument("contacts: the reach must not be negative");
  for (const ContactOptions::With& with : options_.obstacles) {
    if (!with.obstacle) throw InvalidArgument("contacts: an obstacle is missing");
  }
  BodySurface surface = body_surface(simplices, points);
  if (options_.with_itself) itself_.emplace(simplices, points, surface);
  surface_ = std::move(surface.vertices);
  sort_into_runs(surface_, kInCluster, points);
  clusters_.resize(chunk_count(index_size(surface_), kInCluster));
  boxes_.resize(clusters_.size());
}

void ContactFinder::find(std::span<const double> positions, std::span<const double> from,
                         std::vector<Contact>& contacts) {
  check(positions, "ContactFinder::find");
  check(from, "ContactFinder::find");
  contacts.clear();
  if (itself_) itself_->find(positions, options_.friction_with_itself, contacts);
  find_near({positions, from}, options_.reach);
  for_each_chunk(index_size(surface_), kInCluster, [&](Index c, Index begin, Index end) {
    Cluster& cluster = clusters_[c];
    cluster.found.clear();
    for (const Index o : cluster.near) {
      const auto& [obstacle, friction] = options_.obstacles[o];
      for (Index i = begin; i < end; ++i) {
        const Index v = surface_[i];
        if (const auto place = obstacle->nearest(point_of(positions, v), point_of(from, v), options_.reach))
          cluster.found.push_back(contact_with(v, *place, friction, o));
      }
    }
  });
  for (const Cluster& cluster : clusters_)
    contacts.insert(contacts.end(), cluster.found.begin(), cluster.found.end());
  std::sort(contacts.begin(), contacts.end(), comes_before);
}

Penetration ContactFinder::penetration(std::span<const double> positions) {
  check(positions, "ContactFinder::penetration");
  find_near({positions}, 0.0);
  for_each_chunk(index_size(surface_), kInCluster, [&](Index c, Index begin, Index end) {
    Cluster& cluster = clusters_[c];
    cluster.deepest = 0.0;
    for (const Index o : cluster.near) {
      for (Index i = begin; i < end; ++i) {
        const Point x = point_of(positions, surface_[i]);
        if (is_finite(x))
          cluster.deepest = std::max(cluster.deepest, -options_.obstacles[o].obstacle->distance(x));
      }
    }
  });
  Penetration result;
  for (const Cluster& cluster : clusters_)
    result.into_obstacles = std::max(result.into_obstacles, cluster.deepest);
  if (itself_) result.vertices_in_itself = itself_->vertices_inside(positions);
  return result;
}

std::size_t ContactFinder::bytes() const {
  std::size_t sum = surface_.capacity() * sizeof(Index) + boxes_.capacity() * sizeof(Box) +
                    clusters_.capacity() * sizeof(Cluster);
  if (itself_) sum += itself_->bytes();
  for (const Cluster& cluster : clusters_)
    sum += cluster.near.capacity() * sizeof(Index) + cluster.found.capacity() * sizeof(Contact);
  return sum;
}

}  // namespace meshorder
