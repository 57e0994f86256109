// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/calibration_lattices.hpp"

#include "base/random.hpp"
#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include <meshorder/order.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Makes a wavy sheet of (size + 1)² vertices and 2 size² triangles.
Mesh make_sheet(Index size) {
  Mesh mesh;
  mesh.dimension = 3;
  for (Index j = 0; j <= size; ++j) {
    for (Index i = 0; i <= size; ++i) {
      const double x = 1.0 * i / size;
      const double y = 1.0 * j / size;
      mesh.points.push_back({x, y, 0.1 * std::sin(9 * x) * std::cos(7 * y)});
    }
  }
  for (Index j = 0; j < size; ++j) {
    for (Index i = 0; i < size; ++i) {
      const Index v = j * (size + 1) + i;
      const Index above = v + size + 1;
      mesh.cells.push_back(Shape::triangle, std::array{v, v + 1, above + 1});
      mesh.cells.push_back(Shape::triangle, std::array{v, above + 1, above});
    }
  }
  return mesh;
}

std::vector<LatticeOrder> orders_for(Index vertices, Offset row_bytes, const Caches& caches,
                                     std::size_t most) {
  std::vector<Index> windows;
  constexpr Offset kPositionBytes = 3 * sizeof(double);
  for (const Offset bytes : caches.level_bytes) {
    for (const Offset each : {row_bytes, 2 * kPositionBytes, kPositionBytes}) {
      const Offset window = bytes / 2 / each;
      if (window >= 4 && window < vertices / 2) windows.push_back(static_cast<Index>(window));
    }
  }
  std::sort(windows.begin(), windows.end());
  std::vector<LatticeOrder> result{LatticeOrder{}};
  for (const Index window : windows) {
    if (2 * window > 3 * result.back().window) result.push_back({window});
  }
  result.push_back({vertices});
  // one place is for the costliest order
  const std::size_t kept = std::max<std::size_t>(3, most) - 1;
  if (result.size() > kept) {
    std::vector<LatticeOrder> some;
    for (std::size_t i = 0; i < kept; ++i) some.push_back(result[i * (result.size() - 1) / (kept - 1)]);
    result = std::move(some);
  }
  result.push_back({vertices, LatticeElements::shuffled});
  result.insert(result.begin() + 1, {0});
  return result;
}

}  // namespace

CalibrationLattice make_calibration_lattice(Index vertices, bool flat, const Caches& caches,
                                            std::size_t most) {
  const auto along = static_cast<Index>(std::lround(flat ? std::sqrt(vertices) : std::cbrt(vertices)));
  const Index size = std::max<Index>(3, along - 1);
  CalibrationLattice lattice;
  lattice.mesh = flat ? make_sheet(size) : make_grid({.size = size});
  lattice.mesh.cell_blocks.clear();
  const CsrGraph graph = vertex_graph(lattice.mesh);
  const MeshOrder order =
      compute_reordering(lattice.mesh, graph, {.methods = {"hilbert", "lexmax"}, .order = {}});
  apply_reordering(lattice.mesh, order);
  lattice.graph = renumbered(graph, order.vertices.permutation.old_to_new());
  const Index n = lattice.mesh.vertex_count();
  // an entry is a number with its column
  const Offset entries = (n + index_size(lattice.graph.neighbours)) / n;
  lattice.orders = orders_for(n, entries * Offset{sizeof(double) + sizeof(Index)}, caches, most);
  return lattice;
}

Mesh in_order(const CalibrationLattice& lattice, const LatticeOrder& order) {
  if (order.window == 0) {
    Mesh mesh = lattice.mesh;
    apply_reordering(mesh,
                     compute_reordering(mesh, lattice.graph, {.methods = {"bfs", "lexmax"}, .order = {}}));
    return mesh;
  }
  const Index n = lattice.mesh.vertex_count();
  std::vector<Index> old_to_new(static_cast<std::size_t>(n));
  std::iota(old_to_new.begin(), old_to_new.end(), 0);
  Random random(static_cast<std::uint64_t>(order.window));
  for (Index first = 0; first < n; first += order.window) {
    const Index count = std::min(order.window, n - first);
    for (Index i = count - 1; i > 0; --i) {
      const auto j = static_cast<Index>(random.below(static_cast<std::uint64_t>(i) + 1));
      std::swap(old_to_new[first + i], old_to_new[first + j]);
    }
    if (n - first <= order.window) break;  // the last window; `first += window` could overflow
  }
  Mesh mesh;
  mesh.dimension = lattice.mesh.dimension;
  mesh.points = lattice.mesh.points;
  mesh.cells = lattice.mesh.cells;
  const Permutation moved = Permutation::from_old_to_new(std::move(old_to_new));
  apply_reordering(mesh, moved, Permutation::identity(mesh.cell_count()));
  const CsrGraph graph = renumbered(lattice.graph, moved.old_to_new());
  const char* const elements = order.elements == LatticeElements::shuffled ? "scrambled" : "lexmax";
  apply_reordering(mesh, compute_reordering(mesh, graph, {.methods = {"original", elements}, .order = {}}));
  return mesh;
}

}  // namespace meshorder
