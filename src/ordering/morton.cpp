// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Morton: A Computer Oriented Geodetic Data Base (1966).
#include "ordering/all_methods.hpp"
#include "ordering/sorted.hpp"
#include "ordering/space_filling.hpp"

namespace meshorder {

Ordering morton_vertices(const VertexProblem& problem, const OrderingOptions&) {
  check_points(problem.points, static_cast<std::size_t>(problem.graph.size()), "morton");
  const LatticePoints lattice = on_lattice(problem.points);
  std::vector<std::uint64_t> keys;
  keys.reserve(lattice.coordinates.size());
  for (const auto& cell : lattice.coordinates) keys.push_back(interleaved(cell, lattice.axes, lattice.bits));
  return {sorted_by(keys), {}};
}

}  // namespace meshorder
