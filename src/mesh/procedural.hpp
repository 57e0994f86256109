// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"

#include <cstdint>

namespace meshorder {

/// A tetrahedral mesh made by rule. Cubes of a lattice are cut into six tetrahedra each around a diagonal
/// (Kuhn 1960); inner vertices are moved at random by up to `jitter` of a lattice step along each axis, so
/// that nothing is exactly regular. All tetrahedra have positive volume: in ball and torus a few vertices go
/// without jitter for that.
struct ProceduralOptions {
  Index size = 20;         ///< lattice cubes across the shape, at least 1
  double jitter = 0.15;    ///< 0 … 0.15
  std::uint64_t seed = 0;  ///< of the jitter
};

/// The unit cube: (size + 1)³ vertices, 6 size³ tetrahedra.
Mesh make_grid(const ProceduralOptions& options);

/// The unit ball: the cube's lattice, drawn into the ball. As many vertices and tetrahedra.
Mesh make_ball(const ProceduralOptions& options);

/// A torus, radius 1 and tube 0.4: size × size cubes through the tube, 8 size around.
Mesh make_torus(const ProceduralOptions& options);

}  // namespace meshorder
