// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/contact.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <vector>

namespace meshorder {

/// The force of a contact: along its normal, and along its surface as a vector, in units of A x.
struct ContactForce {
  double normal = 0.0;
  Point along{};
};

/// Forces of the contacts of one solve, as a first guess for contacts of the next one with the same first
/// vertex and obstacle. Contacts may be in any order; of several contacts with the same vertex and
/// obstacle, the last one counts.
class RememberedForces {
 public:
  void remember(std::span<const Contact> contacts, std::span<const ContactForce> forces) {
    entries_.clear();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      entries_.push_back({contacts[k].vertices[0], contacts[k].with, forces[k]});
    }
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.vertex, a.with) < std::tie(b.vertex, b.with);
    });
  }
  void forget() { entries_.clear(); }

  /// Returns the remembered force for this contact's first vertex and obstacle; 0 if there is none.
  /// O(log contacts).
  [[nodiscard]] ContactForce of(const Contact& contact) const {
    const auto after = std::upper_bound(
        entries_.begin(), entries_.end(), contact, [](const Contact& wanted, const Entry& entry) {
          return std::tie(wanted.vertices[0], wanted.with) < std::tie(entry.vertex, entry.with);
        });
    if (after == entries_.begin()) return {};
    const Entry& entry = after[-1];
    if (entry.vertex != contact.vertices[0] || entry.with != contact.with) return {};
    return entry.force;
  }

  [[nodiscard]] std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    Index vertex = 0;
    std::int32_t with = 0;
    ContactForce force;
  };
  std::vector<Entry> entries_;  ///< sorted by vertex and obstacle
};

}  // namespace meshorder
