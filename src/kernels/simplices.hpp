// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "mesh/simplices.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Simplices are computed eight at a time, the doubles of an AVX-512 register.
inline constexpr Index kBatch = 8;

/// Rest data of simplices for the element kernels, in batches of kBatch: quantity q of simplex s is at
/// `(quantities · (s / kBatch) + q) · kBatch + s % kBatch`. The last batch is filled up with copies of the
/// last simplex that have no volume and so no force.
///
/// With X₀ … X_D the rest corners, Dₘ is the matrix of the columns X_a − X₀ in the simplex's own orthonormal
/// frame, which Gram–Schmidt builds of them: upper triangular, and so is its inverse. An isotropic material
/// does not depend on the frame, and a tetrahedron takes 56 bytes instead of 80. In space the frame is
/// right-handed: of a tetrahedron whose corners turn the other way the last entry on the diagonal is
/// negative, so that det F > 0 says for every tetrahedron that it is not turned inside out. A simplex that is
/// flat to rounding gets the volume 0 and the inverse 0. Volumes are never negative.
struct RestShapes {
  int dimension = 0;
  Offset count = 0;               ///< simplices
  AlignedVector<Index> vertices;  ///< D + 1 quantities: the corners
  AlignedVector<double>
      geometry;  ///< D(D + 1)/2 + 1: upper triangle of Dₘ⁻¹ row by row; volume (area, length)

  /// Quantities in `geometry`.
  [[nodiscard]] int quantities() const noexcept { return dimension * (dimension + 1) / 2 + 1; }
  [[nodiscard]] Offset batches() const noexcept { return (count + kBatch - 1) / kBatch; }

  /// Returns corner `a` of simplex s; the volume of simplex s.
  [[nodiscard]] Index vertex(Offset s, Index a) const {
    return vertices[(s / kBatch * (dimension + 1) + a) * kBatch + s % kBatch];
  }
  [[nodiscard]] double volume(Offset s) const {
    return geometry[(s / kBatch * quantities() + quantities() - 1) * kBatch + s % kBatch];
  }
};

/// Returns the rest shapes of the simplices at the given points. O(simplices).
RestShapes rest_shapes(const Simplices& simplices, std::span<const Point> points);

}  // namespace meshorder
