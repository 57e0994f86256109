// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/fluid/particles.hpp"
#include "lab/fluid/triangulation.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace meshorder {

/// The mesh of a fluid: the part of a triangulation in which particles are near each other.
struct FluidMesh {
  std::vector<Index> corners;       ///< 4 of each tetrahedron, positively oriented
  double flat = 0;                  ///< m³; smaller tetrahedra join vertices but are not integrated
  std::vector<std::uint8_t> alone;  ///< whether a particle has only flat tetrahedra, or no tetrahedra
  std::vector<std::uint8_t> free;   ///< whether a particle is alone or lies on the free surface

  [[nodiscard]] CellsView view() const { return CellsView::uniform(Shape::tetrahedron, 4, corners); }
  /// Returns the tetrahedra as cells of a mesh.
  [[nodiscard]] Cells cells() const;
  [[nodiscard]] Offset tetrahedra() const noexcept { return static_cast<Offset>(corners.size() / 4); }
};

/// Returns the alpha shape (Edelsbrunner, Mücke 1994) of a triangulation: the tetrahedra whose circumscribed
/// sphere has a radius below 1.35 spacings. A face between the shape and the outside is on the free surface
/// unless its corners all lie on one wall. Tetrahedra of at most 0.003 cubic spacings are flat.
/// O(tetrahedra).
FluidMesh alpha_shape(const Triangulation& triangulation, std::span<const Point> points,
                      std::span<const Walls> walls, double spacing);

/// Returns the faces between the mesh and the outside, anticlockwise as seen from outside. O(tetrahedra).
std::vector<std::array<Index, 3>> outer_faces(const FluidMesh& mesh);

}  // namespace meshorder
