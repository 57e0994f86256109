// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/contact.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Contacts as the rows of a matrix C that acts on positions. C x holds the coordinate of each contact along
/// its normal, normal · Σ w x, then two coordinates along the surface for each contact with friction. Cᵀ maps
/// forces of contacts to forces on vertices.
struct ContactRows {
  std::vector<Index> vertices;               ///< of all contacts, ascending
  std::vector<std::array<Index, 4>> places;  ///< indices in `vertices` of each contact's vertices; −1: absent
  std::vector<std::array<double, 4>> weights;  ///< of each contact; 0 where absent
  std::vector<Point> directions;               ///< of each row
  std::vector<Index> frictional;  ///< contacts with friction; the k-th also has row_of(k) and the row after

  [[nodiscard]] Index contacts() const noexcept { return static_cast<Index>(places.size()); }
  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(directions.size()); }
  [[nodiscard]] Index row_of(Index k) const noexcept { return contacts() + 2 * k; }
};

/// Throws InvalidArgument for a contact without its first vertex, for a vertex that is not among 0 … n−1, for
/// numbers that are not finite, for weights that are all 0, and for negative friction.
void check_contacts(std::span<const Contact> contacts, Index n);

/// Throws InvalidArgument unless the sizes of a solve's vectors b, `from` and x are kPaddedStride · n.
void check_vectors(Index n, std::size_t b, std::size_t from, std::size_t x);

/// Returns the rows of `contacts`, which must pass check_contacts. O(contacts · log contacts).
ContactRows contact_rows(std::span<const Contact> contacts);

/// Computes result = C x, where x has kPaddedStride numbers for each of the n vertices.
template <class Real>
void multiply(const ContactRows& rows, std::span<const Real> x, std::span<double> result);

/// Computes result = C x, where x has 3 numbers for each of rows.vertices.
void multiply_touched(const ContactRows& rows, std::span<const double> x, std::span<double> result);

/// Computes result = Cᵀ forces, 3 numbers for each of rows.vertices.
void multiply_transposed(const ContactRows& rows, std::span<const double> forces, std::span<double> result);

/// Returns the depth of a contact, offset − normal · Σ w x, in m; positive if it is violated.
template <class Real>
double depth(const Contact& contact, std::span<const Real> x);

}  // namespace meshorder
