// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Orders along space-filling curves through the points of a lattice. Morton: A Computer Oriented Geodetic
// Data Base (1966). Hilbert's curve by the transformation of Skilling: Programming the Hilbert Curve (2004).
#include "ordering/space_filling.hpp"

#include "base/parallel.hpp"
#include "base/point.hpp"
#include "base/run_scope.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace meshorder {

void check_points(const PointsView& points, std::size_t count, std::string_view method) {
  if (points.size() != count) {
    throw InvalidArgument("order '" + std::string(method) + "' needs the coordinates of all " +
                          std::to_string(count) + " vertices, got " + std::to_string(points.size()));
  }
}

Lattice::Lattice(const Point& low, const Point& high) : low_(low) {
  for (int a = 0; a < 3; ++a) {
    if (!(high[a] > low[a])) continue;
    used_[axes_++] = a;
    extent_ = std::max(extent_, high[a] - low[a]);
  }
  bits_ = axes_ == 3 ? 21 : 31;
  if (std::isfinite(extent_)) return;
  shrink_ = 0.5;
  extent_ = 0;
  for (int a = 0; a < 3; ++a) extent_ = std::max(extent_, shrink_ * high[a] - shrink_ * low[a]);
}

std::array<std::uint32_t, 3> Lattice::cell_of(const Point& point) const {
  const double cells = std::ldexp(1.0, bits_) - 1;
  std::array<std::uint32_t, 3> cell{0, 0, 0};
  for (int k = 0; k < axes_; ++k) {
    const double share = (shrink_ * point[used_[k]] - shrink_ * low_[used_[k]]) / extent_;
    cell[k] = static_cast<std::uint32_t>(share > 0 ? std::min(share, 1.0) * cells : 0);
  }
  return cell;
}

namespace {

constexpr Index kPointsAtOnce = 16384;  // that a thread looks at together

}  // namespace

Lattice lattice_of(const PointsView& points) {
  const Box box = sum_over_chunks<Box>(index_size(points), kPointsAtOnce, [&](Index begin, Index end) {
    Box of_chunk;
    for (Index i = begin; i < end; ++i) of_chunk += Box{point_at(points, i), point_at(points, i)};
    return of_chunk;
  });
  return {box.low, box.high};
}

std::uint64_t interleaved(const std::array<std::uint32_t, 3>& coordinates, int axes, int bits) {
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    for (int a = 0; a < axes; ++a) key = key << 1U | (coordinates[a] >> static_cast<unsigned>(bit) & 1U);
  }
  return key;
}

namespace {

/// Where a cube of the lattice lies along Hilbert's curve, and how the curve runs through the cubes in it.
struct CurveState {
  std::array<int, 3> axis{0, 1, 2};  ///< which one of the lattice each one of the curve is
  unsigned reflected = 0;            ///< a bit for each axis of the curve
  bool backwards = false;            ///< a Gray code that began with an odd number

  constexpr bool operator==(const CurveState&) const = default;
};

/// One of the halves, quarters or eighths of a cube: its number along the curve in the cube, and the number
/// of its state.
struct CurveStep {
  std::uint8_t number = 0;
  std::uint8_t state = 0;
};

/// Enters the part of a cube that `halves` names by a bit for each axis of the lattice, the first the
/// highest. Returns its number along the curve and its state: Skilling's transformation of one scale.
template <int Axes>
constexpr std::pair<unsigned, CurveState> enter(CurveState state, unsigned halves) {
  unsigned number = 0;
  bool odd = false;
  const CurveState outside = state;
  for (int a = 0; a < Axes; ++a) {
    const unsigned half = (halves >> static_cast<unsigned>(Axes - 1 - outside.axis[a]) ^
                           outside.reflected >> static_cast<unsigned>(a)) &
                          1U;
    odd = odd != (half != 0);
    number = number << 1U | (odd != outside.backwards ? 1U : 0U);
    if (half != 0) {
      state.reflected ^= 1U;
    } else {
      std::swap(state.axis[0], state.axis[a]);
      const unsigned differ = (state.reflected ^ state.reflected >> static_cast<unsigned>(a)) & 1U;
      state.reflected ^= differ | differ << static_cast<unsigned>(a);
    }
  }
  state.backwards = outside.backwards != odd;
  return {number, state};
}

/// Returns the steps from each state into each part; states are numbered as they are found from the first.
template <int Axes>
constexpr auto curve_steps() {
  constexpr unsigned kCubes = 1U << static_cast<unsigned>(Axes);
  std::array<CurveState, 96> states{};  // 6 rotations, 8 reflections, 2 directions
  std::array<std::array<CurveStep, kCubes>, 96> steps{};
  std::size_t found = 1;
  for (std::size_t s = 0; s < found; ++s) {
    for (unsigned halves = 0; halves < kCubes; ++halves) {
      const auto [number, state] = enter<Axes>(states[s], halves);
      std::size_t place = 0;
      while (place < found && !(states[place] == state)) ++place;
      if (place == found) states[found++] = state;
      steps[s][halves] = {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(place)};
    }
  }
  return steps;
}

template <int Axes>
std::uint64_t along_curve(const std::array<std::uint32_t, 3>& x, int bits) {
  static constexpr auto kSteps = curve_steps<Axes>();
  std::uint64_t key = 0;
  std::size_t state = 0;
  for (auto bit = static_cast<unsigned>(bits); bit-- > 0;) {
    unsigned halves = 0;
    for (int a = 0; a < Axes; ++a) halves = halves << 1U | (x[a] >> bit & 1U);
    const CurveStep step = kSteps[state][halves];
    key = key << static_cast<unsigned>(Axes) | step.number;
    state = step.state;
  }
  return key;
}

}  // namespace

std::uint64_t hilbert_key(const std::array<std::uint32_t, 3>& x, int axes, int bits) {
  switch (axes) {
    case 1:
      return along_curve<1>(x, bits);
    case 2:
      return along_curve<2>(x, bits);
    case 3:
      return along_curve<3>(x, bits);
    default:
      return 0;
  }
}

namespace {

/// The number of each point along the curve that `key(coordinates, axes, bits)` gives.
template <class Key>
std::vector<std::uint64_t> keys_of(const PointsView& points, Key key) {
  const Lattice lattice = lattice_of(points);
  std::vector<std::uint64_t> keys(points.size());
  for_each_chunk(index_size(keys), kPointsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
      keys[i] = key(lattice.cell_of(point_at(points, i)), lattice.axes(), lattice.bits());
  });
  return keys;
}

Permutation along_hilbert_curve(const PointsView& points) { return sorted_by(keys_of(points, hilbert_key)); }

}  // namespace

Order morton_vertices(const VertexInput& input, const OrderOptions&) {
  check_points(input.points, static_cast<std::size_t>(input.graph.size()), "morton");
  return {sorted_by(keys_of(input.points, interleaved)), {}};
}

Order hilbert_vertices(const VertexInput& input, const OrderOptions&) {
  check_points(input.points, static_cast<std::size_t>(input.graph.size()), "hilbert");
  return {along_hilbert_curve(input.points), {}};
}

Order hilbert_elements(const ElementInput& input, const OrderOptions&) {
  const IncidenceRef elements = input.elements;
  check_points(input.points, static_cast<std::size_t>(elements.vertex_count), "hilbert");
  std::vector<Point> centroids(elements.size(), Point{});
  for (Index e = 0; e < elements.size(); ++e) {
    poll_in_loop(e);
    const double share = 1.0 / static_cast<double>(elements[e].size());
    for (const Index v : elements[e]) {
      for (int a = 0; a < 3; ++a) centroids[e][a] += share * input.points(static_cast<std::size_t>(v), a);
    }
  }
  return {along_hilbert_curve(PointsView(centroids)), {}};
}

}  // namespace meshorder
