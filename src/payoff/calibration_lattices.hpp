// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "metrics/cache.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder {

/// How the elements of a lattice are ordered: by `lexmax`, or shuffled all together.
enum class LatticeElements { lexmax, shuffled };

/// An order of a lattice's vertices and elements. Vertices follow a Hilbert curve and are then shuffled
/// within ranges of `window` vertices (1: not at all). A window of 0 means breadth first with `lexmax`
/// elements: an order so regular that a processor predicts most loop ends.
struct LatticeOrder {
  Index window = 1;
  LatticeElements elements = LatticeElements::lexmax;

  bool operator==(const LatticeOrder&) const = default;
};

/// A lattice whose orders are timed.
struct CalibrationLattice {
  Mesh mesh;       ///< its vertices are ordered along a Hilbert curve
  CsrGraph graph;  ///< vertex graph of `mesh`
  std::vector<LatticeOrder> orders;
};

/// Makes a lattice of about `vertices` vertices: cubes of six tetrahedra each or, if flat, squares of two
/// triangles. The windows have sizes such that half of a cache holds data of a window's vertices: their
/// positions, their positions and forces, or their rows of the matrix. Other orders shuffle no vertex, all
/// vertices, or all vertices and elements. So the orders differ in which caches they miss. The lattice gets
/// at most `most` of these orders (at least three), evenly chosen and including both extremes, and a
/// breadth-first order, which comes second.
CalibrationLattice make_calibration_lattice(Index vertices, bool flat, const Caches& caches,
                                            std::size_t most);

/// Returns the lattice in one of its orders. Deterministic.
Mesh in_order(const CalibrationLattice& lattice, const LatticeOrder& order);

}  // namespace meshorder
