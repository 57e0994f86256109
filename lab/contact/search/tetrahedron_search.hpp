// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/simplices.hpp"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace meshorder {

/// A vertex strictly inside a tetrahedron of other vertices (see weights_inside).
struct VertexInside {
  Index vertex = 0;
  Index tetrahedron = 0;
  std::array<double, 4> weights{};  ///< barycentric, in the sequence of `TetrahedronSearch::corners`
};

/// Finds the vertices that are inside tetrahedra, in any motion of the body, exactly as a test of every
/// vertex against every tetrahedron would. The result has the same bits for any number of threads and after
/// any earlier calls.
class TetrahedronSearch {
 public:
  /// Searches for `vertices`, ascending. The body is at rest at `points`. Tetrahedra whose volume is negative
  /// at rest get two corners swapped; tetrahedra that are flat at rest contain nothing.
  TetrahedronSearch(const Simplices& simplices, std::span<const Point> points,
                    std::span<const Index> vertices);
  ~TetrahedronSearch();
  TetrahedronSearch(TetrahedronSearch&&) noexcept;
  TetrahedronSearch& operator=(TetrahedronSearch&&) noexcept;
  TetrahedronSearch(const TetrahedronSearch&) = delete;
  TetrahedronSearch& operator=(const TetrahedronSearch&) = delete;

  /// Sets `inside` to all vertices inside at `positions` (kPaddedStride numbers for each vertex), sorted by
  /// vertex and then by tetrahedron.
  void find(std::span<const double> positions, std::vector<VertexInside>& inside);

  /// Returns the corners of a tetrahedron that is not flat at rest, in the sequence of positive volume.
  [[nodiscard]] std::array<Index, 4> corners(Index tetrahedron) const;
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace meshorder
