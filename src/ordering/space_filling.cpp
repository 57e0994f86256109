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
#include <limits>
#include <string>

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

LatticePoints on_lattice(const PointsView& points) {
  LatticePoints result;
  if (points.size() == 0) return result;

  // the bounding box
  const Index n = index_size(points);
  Point low = point_at(points, 0);
  Point high = low;
  for (Index i = 0; i < n; ++i) {
    poll_in_loop(i);
    const Point point = point_at(points, i);
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], point[a]);
      high[a] = std::max(high[a], point[a]);
    }
  }

  const Lattice lattice(low, high);
  result.axes = lattice.axes();
  result.bits = lattice.bits();
  result.coordinates.reserve(points.size());
  for (Index i = 0; i < n; ++i) {
    poll_in_loop(i);
    result.coordinates.push_back(lattice.cell_of(point_at(points, i)));
  }
  return result;
}

std::uint64_t interleaved(const std::array<std::uint32_t, 3>& coordinates, int axes, int bits) {
  std::uint64_t key = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    for (int a = 0; a < axes; ++a) key = key << 1U | (coordinates[a] >> static_cast<unsigned>(bit) & 1U);
  }
  return key;
}

std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x, int axes, int bits) {
  if (axes == 0) return 0;
  // undo the rotations and reflections of each scale, from the coarsest
  for (std::uint32_t q = 1U << static_cast<unsigned>(bits - 1); q > 1; q >>= 1U) {
    const std::uint32_t below = q - 1;
    for (int a = 0; a < axes; ++a) {
      if ((x[a] & q) != 0) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ x[a]) & below;
        x[0] ^= swapped;
        x[a] ^= swapped;
      }
    }
  }
  // Gray code
  for (int a = 1; a < axes; ++a) x[a] ^= x[a - 1];
  std::uint32_t flips = 0;
  for (std::uint32_t q = 1U << static_cast<unsigned>(bits - 1); q > 1; q >>= 1U) {
    if ((x[axes - 1] & q) != 0) flips ^= q - 1;
  }
  for (int a = 0; a < axes; ++a) x[a] ^= flips;
  return interleaved(x, axes, bits);
}

namespace {

constexpr Index kPointsAtOnce = 16384;  // whose keys a thread finds together

/// The number of each point along the curve that `key(coordinates, axes, bits)` gives.
template <class Key>
std::vector<std::uint64_t> keys_of(const LatticePoints& lattice, Key key) {
  std::vector<std::uint64_t> keys(lattice.coordinates.size());
  for_each_chunk(index_size(keys), kPointsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) keys[i] = key(lattice.coordinates[i], lattice.axes, lattice.bits);
  });
  return keys;
}

Permutation along_hilbert_curve(const PointsView& points) {
  return sorted_by(keys_of(on_lattice(points), hilbert_key));
}

}  // namespace

Order morton_vertices(const VertexInput& input, const OrderOptions&) {
  check_points(input.points, static_cast<std::size_t>(input.graph.size()), "morton");
  const LatticePoints lattice = on_lattice(input.points);
  return {sorted_by(keys_of(lattice, interleaved)), {}};
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
