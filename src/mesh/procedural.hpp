// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <cstdint>

namespace meshorder {

/// Options of a procedural tetrahedral mesh. Each cube of a lattice is cut into six tetrahedra around a
/// diagonal (Kuhn 1960); inner vertices are moved at random by up to `jitter` of a lattice step along each
/// axis. All tetrahedra have positive volume, because a few vertices of ball and torus have no jitter.
struct ProceduralOptions {
  Index size = 20;         ///< lattice cubes across the shape, at least 1
  double jitter = 0.15;    ///< 0 … 0.15
  std::uint64_t seed = 0;  ///< seed of the jitter
};

/// Makes the unit cube: (size + 1)³ vertices, 6 size³ tetrahedra.
Mesh make_grid(const ProceduralOptions& options);

/// Makes the ball of radius 1 from the lattice of `make_grid`, with the same numbers of vertices and
/// tetrahedra.
Mesh make_ball(const ProceduralOptions& options);

/// Makes a torus of radius 1 and tube radius 0.4: size × size lattice cubes across the tube, 8 · size cubes
/// along the ring.
Mesh make_torus(const ProceduralOptions& options);

}  // namespace meshorder
