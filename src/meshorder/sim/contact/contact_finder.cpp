// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/base/parallel.hpp>
#include <meshorder/sim/contact/body_surface.hpp>
#include <meshorder/sim/contact/box_tree.hpp>
#include <meshorder/sim/contact/contact_finder.hpp>
#include <meshorder/sim/contact/halving.hpp>
#include <meshorder/sim/contact/self_contact.hpp>
#include <meshorder/sim/contact/vectors.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace meshorder {
namespace {

/// Neighbours that are looked at together, so that one distance tells that all of them are out of reach.
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

/// By vertex, then obstacle, the body itself last.
bool comes_before(const Contact& a, const Contact& b) {
  if (a.vertices[0] != b.vertices[0]) return a.vertices[0] < b.vertices[0];
  return !a.is_with_itself() && (b.is_with_itself() || a.with < b.with);
}

/// Whether nothing of an obstacle is within reach of the box around some vertices and where they were, so
/// that none is near it nor went through it: distances change by no more than the way.
bool out_of_reach(const Obstacle& obstacle, const Box& box, double reach) {
  constexpr double kAboveRounding = 1.0 + 1e-9;
  const Point center = scaled(0.5, plus_scaled(box.lower, 1.0, box.upper));
  const double radius = 0.5 * norm(minus(box.upper, box.lower));
  return obstacle.distance(center) > kAboveRounding * (radius + reach);
}

}  // namespace

struct ContactFinder::State {
  ContactOptions options;
  Index vertex_count = 0;
  std::vector<Index> surface;  ///< its vertices, in clusters
  std::optional<SelfContact> itself;
  std::vector<std::vector<Contact>> by_cluster;

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
  state_->by_cluster.resize(chunk_count(index_size(state_->surface), kInCluster));
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
  const Index obstacles = index_size(state.options.obstacles);
  for_each_chunk(index_size(state.surface), kInCluster, [&](Index cluster, Index begin, Index end) {
    std::vector<Contact>& found = state.by_cluster[cluster];
    found.clear();
    Box box;
    for (Index i = begin; i < end; ++i) {
      box.include(point_of(positions, state.surface[i]));
      box.include(point_of(from, state.surface[i]));
    }
    for (Index o = 0; o < obstacles; ++o) {
      const auto& [obstacle, friction] = state.options.obstacles[o];
      if (out_of_reach(*obstacle, box, state.options.reach)) continue;
      for (Index i = begin; i < end; ++i) {
        const Index v = state.surface[i];
        if (const auto place =
                obstacle->nearest(point_of(positions, v), point_of(from, v), state.options.reach))
          found.push_back(contact_with(v, *place, friction, o));
      }
    }
  });
  for (const std::vector<Contact>& found : state.by_cluster)
    contacts.insert(contacts.end(), found.begin(), found.end());
  std::sort(contacts.begin(), contacts.end(), comes_before);
}

Penetration ContactFinder::penetration(std::span<const double> positions) {
  State& state = *state_;
  state.check(positions, "ContactFinder::penetration");
  std::vector<double> deepest(state.by_cluster.size(), 0.0);
  for_each_chunk(index_size(state.surface), kInCluster, [&](Index cluster, Index begin, Index end) {
    Box box;
    for (Index i = begin; i < end; ++i) box.include(point_of(positions, state.surface[i]));
    for (const ContactOptions::With& with : state.options.obstacles) {
      if (out_of_reach(*with.obstacle, box, 0.0)) continue;
      for (Index i = begin; i < end; ++i) {
        const Point x = point_of(positions, state.surface[i]);
        if (is_finite(x)) deepest[cluster] = std::max(deepest[cluster], -with.obstacle->distance(x));
      }
    }
  });
  Penetration result;
  for (const double depth : deepest) result.into_obstacles = std::max(result.into_obstacles, depth);
  if (state.itself) {
    const SelfContact::Depth depth = state.itself->depth(positions);
    result.into_itself = depth.deepest;
    result.vertices_in_itself = depth.vertices;
  }
  return result;
}

std::size_t ContactFinder::bytes() const {
  std::size_t sum = state_->surface.capacity() * sizeof(Index);
  if (state_->itself) sum += state_->itself->bytes();
  for (const std::vector<Contact>& found : state_->by_cluster) sum += found.capacity() * sizeof(Contact);
  return sum;
}

}  // namespace meshorder
