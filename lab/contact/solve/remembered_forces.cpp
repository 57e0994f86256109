// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/remembered_forces.hpp"

#include <algorithm>
#include <tuple>

namespace meshorder {

void RememberedForces::remember(std::span<const Contact> contacts, std::span<const ContactForce> forces) {
  entries_.clear();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    entries_.push_back({contacts[k].vertices[0], contacts[k].with, forces[k]});
  }
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.vertex, a.with) < std::tie(b.vertex, b.with);
  });
}

ContactForce RememberedForces::of(const Contact& contact) const {
  const auto behind = std::upper_bound(
      entries_.begin(), entries_.end(), contact, [](const Contact& wanted, const Entry& entry) {
        return std::tie(wanted.vertices[0], wanted.with) < std::tie(entry.vertex, entry.with);
      });
  if (behind == entries_.begin()) return {};
  const Entry& entry = behind[-1];
  if (entry.vertex != contact.vertices[0] || entry.with != contact.with) return {};
  return entry.force;
}

}  // namespace meshorder
