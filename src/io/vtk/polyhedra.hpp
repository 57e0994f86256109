// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace meshorder::vtk {

/// VTK's number of the cell type.
inline constexpr int kPolyhedron = 42;

/// The faces of the polyhedra of a mesh, as legacy files have them: of each polyhedron the number of its
/// faces, then of each face the number of its corners, and these in turn.
struct Polyhedra {
  std::vector<Offset> starts;  ///< cells + 1: where the numbers of each cell begin; empty for no polyhedra
  std::vector<Index> numbers;
  bool are_by_face = false;  ///< the .vtu file lists faces and cells apart, as VTK does since 9.4

  [[nodiscard]] bool empty() const { return starts.empty(); }
  /// Returns the numbers of a cell, none for one that is no polyhedron.
  [[nodiscard]] std::span<const Index> operator[](Index cell) const {
    const auto c = static_cast<std::size_t>(cell);
    return {numbers.data() + starts[c], numbers.data() + starts[c + 1]};
  }

  /// Returns those of the mesh after its vertices and cells moved, as FormatMetadata::moved has it.
  /// O(numbers).
  [[nodiscard]] Polyhedra moved(std::span<const Index> new_vertices, std::span<const Index> new_cells) const;
};

/// Returns whether these are the numbers of a polyhedron: counts that agree with their own number.
bool are_faces(std::span<const Index> numbers);

/// Calls `visit` with the corners of each face of a polyhedron, whose numbers `are_faces`.
template <class Number, class Visit>
void for_faces(std::span<Number> numbers, const Visit& visit) {
  for (std::size_t at = 1; at < numbers.size();) {
    const auto corners = static_cast<std::size_t>(numbers[at]);
    visit(numbers.subspan(at + 1, corners));
    at += 1 + corners;
  }
}

}  // namespace meshorder::vtk
