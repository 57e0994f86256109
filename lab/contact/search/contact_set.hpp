// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/contact_finder.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// The contacts of a body during a step. A vertex that was pushed out of the body itself lies on the body's
/// surface and is not found again. Its contact is kept while the contact has a force, so that the vertex does
/// not sink in again.
class ContactSet {
 public:
  explicit ContactSet(ContactFinder finder) : finder_(std::move(finder)) {}

  /// Begins a step from the positions `from` (padded, see padded_positions; must outlive the step), and
  /// forgets earlier contacts.
  void begin(std::span<const double> from);

  /// Finds the contacts at these positions, in ContactFinder's order. `forces` are the forces of contacts(),
  /// empty if nothing was solved since `begin`. Returns whether a contact that was found is violated by more
  /// than `tolerance`, m. The gap required of contacts with the body itself is at most a tenth of
  /// `tolerance`.
  bool update(std::span<const double> positions, std::span<const double> forces, double tolerance);

  [[nodiscard]] std::span<const Contact> contacts() const noexcept { return contacts_; }
  [[nodiscard]] ContactFinder& finder() noexcept { return finder_; }
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  ContactFinder finder_;
  std::span<const double> from_;
  std::vector<Contact> contacts_;
  std::vector<Contact> found_;
  std::vector<Contact> earlier_;
};

}  // namespace meshorder
