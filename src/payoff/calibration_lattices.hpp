// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "metrics/cache.hpp"
#include <meshorder/mesh.hpp>

#include <vector>

namespace meshorder {

/// How the elements of a lattice are ordered: by `lexmax`, or shuffled all together.
enum class LatticeElements { lexmax, shuffled };

/// How the vertices and elements of a lattice are ordered: along a Hilbert curve, then shuffled within ranges
/// of `window` vertices (1: not at all), and the elements. With a window of 0 breadth first, in which a
/// lattice is so regular that a processor foresees where most loops end.
struct LatticeOrder {
  Index window = 1;
  LatticeElements elements = LatticeElements::lexmax;

  bool operator==(const LatticeOrder&) const = default;
};

/// A lattice whose orders are timed.
struct CalibrationLattice {
  Mesh mesh;       ///< along a Hilbert curve
  CsrGraph graph;  ///< of its vertices
  std::vector<LatticeOrder> orders;
};

/// Makes a lattice of about so many vertices: cubes of six tetrahedra each, or, flat, squares of two
/// triangles. Its orders have windows of which half of one of these caches holds the vertices' positions,
/// positions and forces, or rows of the matrix, and the whole of it, so that which cache is missed differs
/// from order to order. At most `most` orders and the breadth-first one, which comes second: the two ends,
/// and others between evenly.
CalibrationLattice make_calibration_lattice(Index vertices, bool flat, const Caches& caches,
                                            std::size_t most);

/// Returns the lattice in one of its orders. The same on every call.
Mesh in_order(const CalibrationLattice& lattice, const LatticeOrder& order);

}  // namespace meshorder
