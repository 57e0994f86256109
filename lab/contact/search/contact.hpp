// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "base/point.hpp"

#include <array>
#include <cstdint>

namespace meshorder {

/// A linearised constraint of a vertex against an obstacle or the body itself: normal · Σ weights[k]
/// x[vertices[k]] ≥ offset.
///
/// Against an obstacle one vertex has the weight 1 and the other vertices are absent. Against the body itself
/// the first vertex has the weight 1. The others are corners of a triangle of the body's surface; their
/// weights are the negated barycentric weights of a point of that triangle, so that all weights add up to 0.
struct Contact {
  static constexpr Index kAbsent = -1;

  std::array<Index, 4> vertices{kAbsent, kAbsent, kAbsent, kAbsent};
  std::array<double, 4> weights{};
  Point normal{};         ///< of length 1, out of the obstacle or the body
  double offset = 0.0;    ///< m
  double friction = 0.0;  ///< Coulomb's coefficient
  std::int32_t with = 0;  ///< number of the obstacle; −1 for the body itself

  [[nodiscard]] bool is_with_itself() const noexcept { return vertices[1] != kAbsent; }
};

/// Orders contacts by vertex, then by obstacle, the body itself last.
inline bool comes_before(const Contact& a, const Contact& b) {
  if (a.vertices[0] != b.vertices[0]) return a.vertices[0] < b.vertices[0];
  return !a.is_with_itself() && (b.is_with_itself() || a.with < b.with);
}

}  // namespace meshorder
