// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/number_view.hpp>
#include <meshorder/shape.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace meshorder {

/// A face of a polyhedron.
struct PolyhedronFace {
  std::span<const Index> corners;  ///< in order around the face
  bool is_inward = false;          ///< whether the normal that the corners turn around points inward
};

/// The cell that the faces of a polyhedron form.
struct CellOfFaces {
  enum class Kind : std::uint8_t {
    standard,  ///< a tetrahedron, pyramid, wedge or hexahedron
    other,     ///< any other pattern of faces
    open       ///< fewer than four faces, or an edge that does not belong to exactly two faces
  };
  Kind kind = Kind::other;
  Shape shape = Shape::tetrahedron;  ///< shape of a standard cell
  std::array<Index, 8> corners{};    ///< corners of a standard cell, in the order of `Cells`
  int size = 0;                      ///< number of corners
  bool signs_agree = false;          ///< whether `is_inward` is right for all faces, or wrong for all

  [[nodiscard]] std::span<const Index> cell() const {
    return {corners.data(), static_cast<std::size_t>(size)};
  }
};

/// Returns the cell that these faces enclose, whatever their order. Its orientation is that of the first
/// face; the orientations of other faces only affect `signs_agree`. O(faces² + edges²) time for up to six
/// faces of up to four corners. Polyhedra with more faces or corners get the kind `other` in O(faces) time;
/// their edges are not examined.
CellOfFaces cell_of_faces(std::span<const PolyhedronFace> faces);

/// Turns a linear tetrahedron, pyramid, wedge or hexahedron inside out.
void turn_inside_out(Shape shape, std::span<Index> corners);

}  // namespace meshorder
