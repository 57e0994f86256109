// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/node_contacts.hpp"

#include "lab/contact/solve/contact_rows.hpp"

#include <algorithm>
#include <cmath>

namespace meshorder {
namespace {

constexpr int kMaxRounds = 50;
// a round that moves a node less than this part of what it has moved at all ends the projection
constexpr double kStill = 1e-12;

void add(double factor, const Point& b, Point& a) {
  for (std::size_t c = 0; c < 3; ++c) a[c] += factor * b[c];
}

Point difference(Point a, const Point& b) {
  add(-1.0, b, a);
  return a;
}

/// The tangential force that is nearest to `force` less what a slip asks for, within its bound.
Point rubbed(Point force, const Point& slip, const Contact& contact, double penalty, double radius) {
  add(-penalty, slip, force);
  add(-dot(force, contact.normal), contact.normal, force);
  const double length = std::sqrt(dot(force, force));
  if (length > radius) {
    for (double& c : force) c *= radius / length;
  }
  return force;
}

double square(const ContactForce& change) {
  return change.normal * change.normal + dot(change.along, change.along);
}

}  // namespace

void NodeContacts::take_contacts(std::span<const Contact> contacts, std::span<const ContactForce> first,
                                 std::span<const double> from) {
  entries_.clear();
  forces_.assign(first.begin(), first.end());
  from_.assign(contacts.size(), Point{});
  radii_.assign(contacts.size(), 0.0);
  penalties_.assign(contacts.size(), 0.0);
  has_updates_ = false;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Index v = contacts[k].vertices[i];
      if (v != Contact::kAbsent) entries_.push_back({v, static_cast<Index>(k), contacts[k].weights[i]});
    }
    has_updates_ = has_updates_ || contacts[k].is_with_itself() || contacts[k].friction > 0.0;
    if (contacts[k].friction <= 0.0) {
      forces_[k].along = {};
      continue;
    }
    from_[k] = place(contacts[k], from);
    radii_[k] = contacts[k].friction * forces_[k].normal;
    forces_[k].along = rubbed(forces_[k].along, {}, contacts[k], 0.0, radii_[k]);
  }
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.vertex < b.vertex; });
  vertices_.clear();
  offsets_.clear();
  tied_.clear();
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (i == 0 || entries_[i].vertex != entries_[i - 1].vertex) {
      vertices_.push_back(entries_[i].vertex);
      offsets_.push_back(static_cast<Index>(i));
      tied_.push_back(0);
    }
    if (contacts[entries_[i].contact].is_with_itself()) tied_.back() = 1;
  }
  offsets_.push_back(index_size(entries_));
}

ContactForce NodeContacts::pushed(const Contact& contact, Index k, const Point& place) const {
  ContactForce force = forces_[k];
  const double depth = contact.offset - dot(contact.normal, place);
  force.normal = std::max(0.0, force.normal + penalties_[k] * depth);
  if (radii_[k] > 0.0)
    force.along = rubbed(force.along, difference(place, from_[k]), contact, penalties_[k], radii_[k]);
  return force;
}

template <class Real>
void NodeContacts::add_ties(std::span<const Contact> contacts, Index node, std::span<const Real> x,
                            Point& force, double& stiffness) const {
  for (const Entry& entry : entries(node)) {
    const Contact& contact = contacts[entry.contact];
    if (!contact.is_with_itself()) continue;
    const ContactForce push = pushed(contact, entry.contact, place(contact, x));
    add(entry.weight * push.normal, contact.normal, force);
    add(entry.weight, push.along, force);
    stiffness += penalties_[entry.contact] * entry.weight * entry.weight;
  }
}

double NodeContacts::meet(const Contact& contact, const Entry& entry, double way, Point& x) {
  // a force of 1 moves the place by this
  const double moves = way * entry.weight * entry.weight;
  ContactForce& force = forces_[entry.contact];
  const double depth = contact.offset - entry.weight * dot(contact.normal, x);
  const double normal = std::max(0.0, force.normal + depth / moves);
  double moved = std::abs(normal - force.normal);
  add(way * entry.weight * (normal - force.normal), contact.normal, x);
  force.normal = normal;
  if (contact.friction > 0.0) {
    Point slip{};
    add(entry.weight, x, slip);
    slip = difference(slip, from_[entry.contact]);
    const Point along = rubbed(force.along, slip, contact, 1.0 / moves, radii_[entry.contact]);
    const Point change = difference(along, force.along);
    moved += std::sqrt(dot(change, change));
    add(way * entry.weight, change, x);
    force.along = along;
  }
  return way * std::abs(entry.weight) * moved;
}

void NodeContacts::project(std::span<const Contact> contacts, Index node, double way, Point& x) {
  const Point aim = x;
  int hard = 0;
  for (const Entry& entry : entries(node)) {
    const Contact& contact = contacts[entry.contact];
    if (contact.is_with_itself()) continue;
    ++hard;
    add(way * entry.weight * forces_[entry.contact].normal, contact.normal, x);
    add(way * entry.weight, forces_[entry.contact].along, x);
  }
  // one contact is met exactly at once
  for (int round = 0; round < (hard > 1 ? kMaxRounds : hard); ++round) {
    double moved = 0.0;
    for (const Entry& entry : entries(node)) {
      const Contact& contact = contacts[entry.contact];
      if (!contact.is_with_itself()) moved = std::max(moved, meet(contact, entry, way, x));
    }
    const Point all = difference(x, aim);
    if (moved <= kStill * std::sqrt(dot(all, all))) break;
  }
}

template <class Real>
double NodeContacts::update(std::span<const Contact> contacts, std::span<const Real> x) {
  double sum = 0.0;
  for (Index k = 0; k < index_size(contacts); ++k) {
    const Contact& contact = contacts[k];
    if (contact.is_with_itself()) {
      const ContactForce push = pushed(contact, k, place(contact, x));
      sum +=
          square({push.normal - forces_[k].normal, difference(push.along, forces_[k].along)}) / penalties_[k];
      forces_[k] = push;
    }
    if (contact.friction <= 0.0) continue;
    const double radius = contact.friction * forces_[k].normal;
    sum += (radius - radii_[k]) * (radius - radii_[k]) / penalties_[k];
    radii_[k] = radius;
  }
  return std::sqrt(sum);
}

template <class Real>
double NodeContacts::depth_left(std::span<const Contact> contacts, std::span<const Real> x) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    if (contacts[k].is_with_itself()) continue;
    const double left = std::max(0.0, depth(contacts[k], x));
    sum += penalties_[k] * left * left;
  }
  return std::sqrt(sum);
}

template <class Real>
void NodeContacts::take_forces(std::span<const Contact> contacts, std::span<const Real> x,
                               std::span<ContactForce> forces) const {
  for (Index k = 0; k < index_size(contacts); ++k) {
    const bool tie = contacts[k].is_with_itself();
    forces[k] = tie ? pushed(contacts[k], k, place(contacts[k], x)) : forces_[k];
    if (contacts[k].friction <= 0.0) continue;
    const double radius = contacts[k].friction * forces[k].normal;
    forces[k].along = rubbed(forces[k].along, {}, contacts[k], 0.0, radius);
  }
}

template void NodeContacts::add_ties(std::span<const Contact>, Index, std::span<const double>, Point&,
                                     double&) const;
template void NodeContacts::add_ties(std::span<const Contact>, Index, std::span<const float>, Point&,
                                     double&) const;
template double NodeContacts::update(std::span<const Contact>, std::span<const double>);
template double NodeContacts::update(std::span<const Contact>, std::span<const float>);
template double NodeContacts::depth_left(std::span<const Contact>, std::span<const double>) const;
template double NodeContacts::depth_left(std::span<const Contact>, std::span<const float>) const;
template void NodeContacts::take_forces(std::span<const Contact>, std::span<const double>,
                                        std::span<ContactForce>) const;
template void NodeContacts::take_forces(std::span<const Contact>, std::span<const float>,
                                        std::span<ContactForce>) const;

}  // namespace meshorder
