// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/contact_rows.hpp"

#include "kernels/positions.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace meshorder {
namespace {

void check_contact(const Contact& contact, std::size_t number, Index n) {
  const auto refuse = [&](const std::string& what) {
    throw InvalidArgument("contact " + std::to_string(number) + ": " + what);
  };
  if (contact.vertices[0] == Contact::kAbsent) refuse("its first vertex is absent");
  bool finite = std::isfinite(contact.offset) && std::isfinite(contact.friction);
  for (const double c : contact.normal) finite = finite && std::isfinite(c);
  for (std::size_t i = 0; i < 4; ++i) {
    const Index v = contact.vertices[i];
    if (v == Contact::kAbsent) continue;
    if (v < 0 || v >= n)
      refuse("vertex " + std::to_string(v) + " is not among " + std::to_string(n) + " vertices");
    finite = finite && std::isfinite(contact.weights[i]);
  }
  if (!finite) refuse("a number is not finite");
  if (std::all_of(contact.weights.begin(), contact.weights.end(), [](double w) { return w == 0.0; }))
    refuse("all its weights are 0");
  if (contact.friction < 0.0) refuse("its friction is negative");
}

/// Returns two unit vectors at right angles to `normal` and to each other (Duff et al. 2017).
std::array<Point, 2> tangents(const Point& normal) {
  const auto& [x, y, z] = normal;
  const double sign = std::copysign(1.0, z);
  const double a = -1.0 / (sign + z);
  const double b = x * y * a;
  return {{{1.0 + sign * x * x * a, sign * b, -sign * x}, {b, sign + y * y * a, -y}}};
}

/// Returns Σ w x; `stride` is the distance in x from one vertex to the next.
template <class Real>
Point weighted_sum(const std::array<Index, 4>& vertices, const std::array<double, 4>& weights, const Real* x,
                   Index stride) {
  Point sum{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (vertices[i] < 0) continue;
    const Real* const p = x + Offset{stride} * vertices[i];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weights[i] * static_cast<double>(p[c]);
  }
  return sum;
}

/// Multiplies each row of C by the vector that `place_of` returns for the row's contact.
template <class PlaceOf>
void multiply_places(const ContactRows& rows, PlaceOf place_of, std::span<double> result) {
  Index frictional = 0;
  for (Index k = 0; k < rows.contacts(); ++k) {
    const Point x = place_of(k);
    result[k] = dot(rows.directions[k], x);
    if (frictional == index_size(rows.frictional) || rows.frictional[frictional] != k) continue;
    const Index row = rows.row_of(frictional++);
    result[row] = dot(rows.directions[row], x);
    result[row + 1] = dot(rows.directions[row + 1], x);
  }
}

}  // namespace

void check_contacts(std::span<const Contact> contacts, Index n) {
  for (std::size_t k = 0; k < contacts.size(); ++k) check_contact(contacts[k], k, n);
}

void check_vectors(Index n, std::size_t b, std::size_t from, std::size_t x) {
  const std::size_t size = kPaddedStride * static_cast<std::size_t>(n);
  if (b != size || from != size || x != size) {
    throw InvalidArgument("DualContactSolver: b, from and x must hold 4 numbers for each of " +
                          std::to_string(n) + " vertices");
  }
}

ContactRows contact_rows(std::span<const Contact> contacts) {
  ContactRows rows;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    for (const Index v : contacts[k].vertices) {
      if (v != Contact::kAbsent) rows.vertices.push_back(v);
    }
    rows.directions.push_back(contacts[k].normal);
    if (contacts[k].friction > 0.0) rows.frictional.push_back(static_cast<Index>(k));
  }
  std::sort(rows.vertices.begin(), rows.vertices.end());
  rows.vertices.erase(std::unique(rows.vertices.begin(), rows.vertices.end()), rows.vertices.end());
  for (const Contact& contact : contacts) {
    std::array<Index, 4> places{-1, -1, -1, -1};
    std::array<double, 4> weights{};
    for (std::size_t i = 0; i < 4; ++i) {
      if (contact.vertices[i] == Contact::kAbsent) continue;
      const auto found = std::lower_bound(rows.vertices.begin(), rows.vertices.end(), contact.vertices[i]);
      places[i] = static_cast<Index>(found - rows.vertices.begin());
      weights[i] = contact.weights[i];
    }
    rows.places.push_back(places);
    rows.weights.push_back(weights);
  }
  for (const Index k : rows.frictional) {
    for (const Point& tangent : tangents(contacts[k].normal)) rows.directions.push_back(tangent);
  }
  return rows;
}

template <class Real>
void multiply(const ContactRows& rows, std::span<const Real> x, std::span<double> result) {
  multiply_places(
      rows,
      [&](Index k) {
        std::array<Index, 4> vertices = rows.places[k];
        for (Index& v : vertices) v = v < 0 ? v : rows.vertices[v];
        return weighted_sum(vertices, rows.weights[k], x.data(), kPaddedStride);
      },
      result);
}

void multiply_touched(const ContactRows& rows, std::span<const double> x, std::span<double> result) {
  multiply_places(
      rows, [&](Index k) { return weighted_sum(rows.places[k], rows.weights[k], x.data(), 3); }, result);
}

void multiply_transposed(const ContactRows& rows, std::span<const double> forces, std::span<double> result) {
  std::fill(result.begin(), result.end(), 0.0);
  Index frictional = 0;
  for (Index k = 0; k < rows.contacts(); ++k) {
    Point force{};
    const auto add_row = [&](Index row) {
      for (std::size_t c = 0; c < 3; ++c) force[c] += forces[row] * rows.directions[row][c];
    };
    add_row(k);
    if (frictional < index_size(rows.frictional) && rows.frictional[frictional] == k) {
      const Index row = rows.row_of(frictional++);
      add_row(row);
      add_row(row + 1);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Index v = rows.places[k][i];
      if (v < 0) continue;
      for (std::size_t c = 0; c < 3; ++c)
        result[3 * v + static_cast<Index>(c)] += rows.weights[k][i] * force[c];
    }
  }
}

template <class Real>
double depth(const Contact& contact, std::span<const Real> x) {
  const Point place = weighted_sum(contact.vertices, contact.weights, x.data(), kPaddedStride);
  return contact.offset - dot(contact.normal, place);
}

template void multiply(const ContactRows&, std::span<const double>, std::span<double>);
template void multiply(const ContactRows&, std::span<const float>, std::span<double>);
template double depth(const Contact&, std::span<const double>);
template double depth(const Contact&, std::span<const float>);

}  // namespace meshorder
