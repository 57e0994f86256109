// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/contact_finder.hpp"

#include "base/parallel.hpp"
#include "kernels/positions.hpp"
#include "lab/contact/geometry/box_tree.hpp"
#include "lab/contact/search/body_surface.hpp"
#include "lab/contact/search/self_contact.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>

namespace meshorder {
namespace {

/// Neighbours in a cluster: one distance can show that all of them are out of reach.
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
/// Then no vertex is near the obstacle or went through it: a distance changes by at most the path length.
bool out_of_reach(const Obstacle& obstacle, const Box& box, double reach) {
  constexpr double kAboveRounding = 1.0 + 1e-9;
  const Point center = scaled(0.5, plus_scaled(box.lower, 1.0, box.upper));
  const double radius = 0.5 * norm(minus(box.upper, box.lower));
  return obstacle.distance(center) > kAboveRounding * (radius + reach);
}

/// Calls `visit(cluster)` for clusters begin … end − 1 that are not out of reach of the obstacle.
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

struct ContactFinder::State {
  ContactOptions options;
  Index vertex_count = 0;
  std::vector<Index> surface;  ///< vertices of the surface, in clusters
  std::optional<SelfContact> itself;
  /// Vertices of the surface that are searched together.
  struct Cluster {
    std::vector<Index> near;  ///< obstacles
    std::vector<Contact> found;
    double deepest = 0.0;
  };
  std::vector<Cluster> clusters;
  std::vector<Box> boxes;  ///< around clusters

  /// Finds the obstacles near each cluster, whose vertices are at any of the positions in `places`.
  void find_near(std::initializer_list<std::span<const double>> places, double reach) {
    for_each_chunk(index_size(surface), kInCluster, [&](Index c, Index begin, Index end) {
      clusters[c].near.clear();
      boxes[c] = {};
      for (const std::span<const double> place : places) {
        for (Index i = begin; i < end; ++i) boxes[c].include(point_of(place, surface[i]));
      }
    });
    for (Index o = 0; o < index_size(options.obstacles); ++o) {
      visit_within_reach(*options.obstacles[o].obstacle, reach, boxes, 0, index_size(clusters),
                         [&](Index c) { clusters[c].near.push_back(o); });
    }
  }

  void check(std::span<const double> positions, const char* function) const {
    if (positions.size() != static_cast<std::size_t>(kPaddedStride) * static_cast<std::size_t>(vertex_count))
      throw InvalidArgument(std::string(function) + ": positions must be those of all points at rest");
  }
};

ContactFinder::ContactFinder(const Simplices& simplices, std::span<const Point> points,
                             ContactOptions options)
    : state_(std::make_unique<State>()) {
  if (!(options.reach >= 0.0)) throw InvalidArgument("contacts: the reach must not be negative");
  for (const ContactOptions::With& with : options.obstacles) {
    if (!with.obstacle) throw InvalidArgument("contacts: an obstacle is missing");
  }
  BodySurface surface = body_surface(simplices, points);
  if (options.with_itself) state_->itself.emplace(simplices, points, surface);
  state_->options = std::move(options);
  state_->vertex_count = index_size(points);
  state_->surface = std::move(surface.vertices);
  sort_into_runs(state_->surface, kInCluster, points);
  state_->clusters.resize(chunk_count(index_size(state_->surface), kInCluster));
  state_->boxes.resize(state_->clusters.size());
}
ContactFinder::~ContactFinder() = default;
ContactFinder::ContactFinder(ContactFinder&&) noexcept = default;
ContactFinder& ContactFinder::operator=(ContactFinder&&) noexcept = default;

void ContactFinder::find(std::span<const double> positions, std::span<const double> from,
                         std::vector<Contact>& contacts) {
  State& state = *state_;
  state.check(positions, "ContactFinder::find");
  state.check(from, "ContactFinder::find");
  contacts.clear();
  if (state.itself) state.itself->find(positions, state.options.friction_with_itself, contacts);
  state.find_near({positions, from}, state.options.reach);
  for_each_chunk(index_size(state.surface), kInCluster, [&](Index c, Index begin, Index end) {
    State::Cluster& cluster = state.clusters[c];
    cluster.found.clear();
    for (const Index o : cluster.near) {
      const auto& [obstacle, friction] = state.options.obstacles[o];
      for (Index i = begin; i < end; ++i) {
        const Index v = state.surface[i];
        if (const auto place =
                obstacle->nearest(point_of(positions, v), point_of(from, v), state.options.reach))
          cluster.found.push_back(contact_with(v, *place, friction, o));
      }
    }
  });
  for (const State::Cluster& cluster : state.clusters)
    contacts.insert(contacts.end(), cluster.found.begin(), cluster.found.end());
  std::sort(contacts.begin(), contacts.end(), comes_before);
}

Penetration ContactFinder::penetration(std::span<const double> positions) {
  State& state = *state_;
  state.check(positions, "ContactFinder::penetration");
  state.find_near({positions}, 0.0);
  for_each_chunk(index_size(state.surface), kInCluster, [&](Index c, Index begin, Index end) {
    State::Cluster& cluster = state.clusters[c];
    cluster.deepest = 0.0;
    for (const Index o : cluster.near) {
      for (Index i = begin; i < end; ++i) {
        const Point x = point_of(positions, state.surface[i]);
        if (is_finite(x))
          cluster.deepest = std::max(cluster.deepest, -state.options.obstacles[o].obstacle->distance(x));
      }
    }
  });
  Penetration result;
  for (const State::Cluster& cluster : state.clusters)
    result.into_obstacles = std::max(result.into_obstacles, cluster.deepest);
  if (state.itself) {
    const SelfContact::Depth depth = state.itself->depth(positions);
    result.into_itself = depth.deepest;
    result.vertices_in_itself = depth.vertices;
  }
  return result;
}

std::size_t ContactFinder::bytes() const {
  std::size_t sum = state_->surface.capacity() * sizeof(Index) + state_->boxes.capacity() * sizeof(Box) +
                    state_->clusters.capacity() * sizeof(State::Cluster);
  if (state_->itself) sum += state_->itself->bytes();
  for (const State::Cluster& cluster : state_->clusters)
    sum += cluster.near.capacity() * sizeof(Index) + cluster.found.capacity() * sizeof(Contact);
  return sum;
}

}  // namespace meshorder
