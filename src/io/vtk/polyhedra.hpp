// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace meshorder::vtk {

/// VTK's type number of a polyhedron.
inline constexpr int kPolyhedron = 42;

/// The faces of the polyhedra of a mesh, as in legacy files. For each polyhedron: its number of faces, then
/// for each face its number of corners and the corners.
struct Polyhedra {
  std::vector<Offset> starts;  ///< start of each cell's numbers, then the end of all; empty: no polyhedra
  std::vector<Index> numbers;
  bool are_by_face = false;  ///< whether the .vtu file lists faces apart from cells, as VTK does since 9.4

  [[nodiscard]] bool empty() const { return starts.empty(); }
  /// Returns the numbers of a cell; empty if the cell is not a polyhedron.
  [[nodiscard]] std::span<const Index> operator[](Index cell) const {
    const auto c = static_cast<std::size_t>(cell);
    return {numbers.data() + starts[c], numbers.data() + starts[c + 1]};
  }

  /// Returns the faces with vertices and cells renumbered; the arguments are those of FormatMetadata::moved.
  /// O(numbers).
  [[nodiscard]] Polyhedra moved(std::span<const Index> new_vertices, std::span<const Index> new_cells) const;
};

/// Returns whether the numbers can describe a polyhedron: the counts in them add up to their size.
bool are_faces(std::span<const Index> numbers);

/// Calls `visit` with the corners of each face of a polyhedron. `are_faces(numbers)` must be true.
template <class Number, class Visit>
void for_faces(std::span<Number> numbers, const Visit& visit) {
  for (std::size_t at = 1; at < numbers.size();) {
    const auto corners = static_cast<std::size_t>(numbers[at]);
    visit(numbers.subspan(at + 1, corners));
    at += 1 + corners;
  }
}

}  // namespace meshorder::vtk
