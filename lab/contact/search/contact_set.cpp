// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/contact_set.hpp"

#include "kernels/positions.hpp"
#include "lab/contact/solve/contact_rows.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

/// Share of the depth that a vertex must lose in a step if it begins the step inside the body itself.
/// Losing the full depth would give vertices arbitrary speeds, and the body would gain energy.
constexpr double kWayOut = 0.5;
/// Gap to the body's own surface at which vertices are held, as a share of the tolerance, so that rounding
/// does not put them inside.
constexpr double kClearance = 0.1;

/// Returns the gap to the body itself that a vertex must have at a step's end if the gap was `gap` at the
/// start. Adds the tolerance, since halving a depth never reaches 0.
double required_gap(double gap, double tolerance) {
  return std::min(kClearance * tolerance, (gap < 0.0 ? (1.0 - kWayOut) * gap : gap) + tolerance);
}

/// Sets the normal of a contact with the body itself to that of its triangle. Returns false if the triangle
/// is flat.
bool follow_triangle(std::span<const double> positions, Contact& contact) {
  const std::optional<Point> normal =
      triangle_normal(positions, contact.vertices[1], contact.vertices[2], contact.vertices[3]);
  if (normal) contact.normal = *normal;
  return normal.has_value();
}

}  // namespace

void ContactSet::begin(std::span<const double> from) {
  from_ = from;
  contacts_.clear();
}

bool ContactSet::update(std::span<const double> positions, std::span<const double> forces, double tolerance) {
  std::swap(earlier_, contacts_);
  finder_.find(positions, from_, found_);
  for (Contact& contact : found_) {
    if (!contact.is_with_itself()) continue;
    contact.offset = required_gap(-depth(contact, from_), tolerance);
  }
  const bool violates = std::any_of(found_.begin(), found_.end(), [&](const Contact& contact) {
    return depth(contact, positions) > tolerance;
  });
  // keeps a contact of the body with itself that pushes, if no new contact was found for its vertex
  std::vector<Contact> kept;
  for (std::size_t i = 0; i < std::min(earlier_.size(), forces.size()); ++i) {
    if (!earlier_[i].is_with_itself() || !(forces[i] > 0.0) ||
        std::binary_search(found_.begin(), found_.end(), earlier_[i], comes_before)) {
      continue;
    }
    Contact contact = earlier_[i];
    if (follow_triangle(positions, contact)) kept.push_back(contact);
  }
  contacts_.clear();
  std::merge(found_.begin(), found_.end(), kept.begin(), kept.end(), std::back_inserter(contacts_),
             comes_before);
  return violates;
}

std::size_t ContactSet::bytes() const {
  return finder_.bytes() + (contacts_.capacity() + found_.capacity() + earlier_.capacity()) * sizeof(Contact);
}

}  // namespace meshorder
