// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/base/error.hpp>
#include <meshorder/base/parallel.hpp>
#include <meshorder/sim/contact/body_surface.hpp>
#include <meshorder/sim/contact/box_tree.hpp>
#include <meshorder/sim/contact/contact_finder.hpp>
#include <meshorder/sim/contact/self_contact.hpp>
#include <meshorder/sim/contact/vectors.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace meshorder {
namespace {

constexpr Index kVerticesAtOnce = 256;

}  // namespace

struct ContactFinder::State {
  ContactOptions options;
  Index vertex_count = 0;
  std::vector<Index> surface;  ///< vertices of the surface, rising
  std::optional<SelfContact> itself;
  std::vector<std::vector<Contact>> by_chunk;
  std::vector<Contact> with_itself;

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
  state_->by_chunk.resize(chunk_count(index_size(state_->surface), kVerticesAtOnce));
}
ContactFinder::~ContactFinder() = default;
ContactFinder::ContactFinder(ContactFinder&&) noexcept = default;
ContactFinder& ContactFinder::operator=(ContactFinder&&) noexcept = default;

namespace {

/// Whether nothing of an obstacle is within reach of the ball around these vertices and their ways: distances
/// change by no more than the way.
bool out_of_reach(const Obstacle& obstacle, const Box& ways, double reach) {
  const Point center = scaled(0.5, plus_scaled(ways.lower, 1.0, ways.upper));
  const double radius = 0.5 * norm(minus(ways.upper, ways.lower));
  constexpr double kAboveRounding = 1.0 + 1e-9;
  return obstacle.distance(center) > kAboveRounding * (radius + reach);
}

}  // namespace

void ContactFinder::find(std::span<const double> positions, std::span<const double> from,
                         std::vector<Contact>& contacts) {
  State& state = *state_;
  state.check(positions, "ContactFinder::find");
  state.check(from, "ContactFinder::find");
  contacts.clear();
  state.with_itself.clear();
  if (state.itself) state.itself->find(positions, state.options.friction_with_itself, state.with_itself);

  const Index obstacles = index_size(state.options.obstacles);
  for_each_chunk(index_size(state.surface), kVerticesAtOnce, [&](Index chunk, Index begin, Index end) {
    std::vector<Contact>& found = state.by_chunk[chunk];
    found.clear();
    Box ways;
    for (Index i = begin; i < end; ++i) {
      ways.include(point_of(positions, state.surface[i]));
      ways.include(point_of(from, state.surface[i]));
    }
    for (Index o = 0; o < obstacles; ++o) {
      const auto& [obstacle, friction] = state.options.obstacles[o];
      if (out_of_reach(*obstacle, ways, state.options.reach)) continue;
      for (Index i = begin; i < end; ++i) {
        const Index v = state.surface[i];
        const auto place = obstacle->nearest(point_of(positions, v), point_of(from, v), state.options.reach);
        if (!place) continue;
        Contact contact;
        contact.vertices[0] = v;
        contact.weights[0] = 1.0;
        contact.normal = place->normal;
        contact.offset = dot(place->normal, place->at);
        contact.friction = friction;
        contact.with = o;
        found.push_back(contact);
      }
    }
    const auto by_vertex = [](const Contact& a, const Contact& b) { return a.vertices[0] < b.vertices[0]; };
    std::stable_sort(found.begin(), found.end(), by_vertex);
  });
  // those with the body itself come behind those of the same vertex with obstacles
  auto itself = state.with_itself.begin();
  for (const std::vector<Contact>& found : state.by_chunk) {
    for (const Contact& contact : found) {
      while (itself != state.with_itself.end() && itself->vertices[0] < contact.vertices[0])
        contacts.push_back(*itself++);
      contacts.push_back(contact);
    }
  }
  contacts.insert(contacts.end(), itself, state.with_itself.end());
}

Penetration ContactFinder::penetration(std::span<const double> positions) {
  State& state = *state_;
  state.check(positions, "ContactFinder::penetration");
  std::vector<double> deepest(state.by_chunk.size(), 0.0);
  for_each_chunk(index_size(state.surface), kVerticesAtOnce, [&](Index chunk, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Point x = point_of(positions, state.surface[i]);
      if (!is_finite(x)) continue;
      for (const ContactOptions::With& with : state.options.obstacles)
        deepest[chunk] = std::max(deepest[chunk], -with.obstacle->distance(x));
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
  for (const std::vector<Contact>& chunk : state_->by_chunk) sum += chunk.capacity() * sizeof(Contact);
  return sum;
}

}  // namespace meshorder
