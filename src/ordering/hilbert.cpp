// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Skilling: Programming the Hilbert Curve (2004), which gives the transformation used here.
#include "base/parallel.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"
#include "ordering/space_filling.hpp"

namespace meshorder {
namespace {

constexpr Index kPointsAtOnce = 16384;  // whose keys a thread finds together

/// The number of a lattice cell along Hilbert's curve.
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

Permutation along_hilbert_curve(std::span<const Point> points) {
  const LatticePoints lattice = on_lattice(points);
  std::vector<std::uint64_t> keys(points.size());
  for_each_chunk(index_size(points), kPointsAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
      keys[i] = hilbert_key(lattice.coordinates[i], lattice.axes, lattice.bits);
  });
  return sorted_by(keys);
}

}  // namespace

Ordering hilbert_vertices(const VertexProblem& problem, const OrderingOptions&) {
  check_points(problem.points, static_cast<std::size_t>(problem.graph.size()), "hilbert");
  return {along_hilbert_curve(problem.points), {}};
}

Ordering hilbert_elements(const ElementProblem& problem, const OrderingOptions&) {
  const Incidence& elements = problem.elements;
  check_points(problem.points, static_cast<std::size_t>(elements.vertex_count), "hilbert");
  std::vector<Point> centroids(elements.size(), Point{});
  for (Index e = 0; e < elements.size(); ++e) {
    const double share = 1.0 / static_cast<double>(elements[e].size());
    for (const Index v : elements[e]) {
      for (int a = 0; a < 3; ++a) centroids[e][a] += share * problem.points[v][a];
    }
  }
  return {along_hilbert_curve(centroids), {}};
}

}  // namespace meshorder
