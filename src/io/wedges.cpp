// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/wedges.hpp"

#include "base/point.hpp"

#include <array>

namespace meshorder {
namespace {

/// The edges from a cell's first corner to three others; right-handed if the cell's volume is positive.
struct Handedness {
  std::size_t corners;  ///< number of corners; 0 for shapes whose volumes are ignored
  std::array<std::size_t, 3> ends;
};

/// The edges for each Shape.
constexpr std::array<Handedness, kShapes> kHandedness = [] {
  std::array<Handedness, kShapes> all{};
  all[static_cast<std::size_t>(Shape::tetrahedron)] = {4, {1, 2, 3}};
  all[static_cast<std::size_t>(Shape::hexahedron)] = {8, {1, 3, 4}};
  all[static_cast<std::size_t>(Shape::pyramid)] = {5, {1, 3, 4}};
  all[static_cast<std::size_t>(Shape::wedge)] = {6, {1, 2, 3}};
  return all;
}();

}  // namespace

double volume_at_first_corner(const std::vector<Point>& points, Shape shape, std::span<const Index> cell) {
  const Handedness& known = kHandedness[static_cast<std::size_t>(shape)];
  if (known.corners != cell.size() || cell.empty()) return 0;
  const auto edge = [&](int k) { return minus(points[cell[known.ends[k]]], points[cell[0]]); };
  return dot(cross(edge(0), edge(1)), edge(2));
}

int WedgeVote::Volumes::sign() const {
  constexpr Offset kOneIn = 20;
  if (kOneIn * negative < positive) return 1;
  return kOneIn * positive < negative ? -1 : 0;
}

void WedgeVote::add(Shape shape, std::span<const Index> cell) {
  const double volume = volume_at_first_corner(points_, shape, cell);
  Volumes& volumes = shape == Shape::wedge ? wedges_ : others_;
  volumes.positive += volume > 0 ? 1 : 0;
  volumes.negative += volume < 0 ? 1 : 0;
}

int WedgeVote::sign_of_volumes() const {
  const Volumes all{wedges_.positive + others_.positive, wedges_.negative + others_.negative};
  return all.sign();
}

bool WedgeVote::wedges_face_inward() const {
  const bool others_tell = others_.positive + others_.negative > 0;
  return wedges_.sign() != 0 && wedges_.sign() == (others_tell ? others_.sign() : 1);
}

}  // namespace meshorder
