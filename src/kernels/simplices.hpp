// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "kernels/aligned.hpp"
#include "mesh/simplices.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// Simplices per batch: as many as an AVX-512 register holds doubles.
inline constexpr Index kBatch = 8;

/// Rest data of simplices for the element kernels, in batches of kBatch: quantity q of simplex s is at
/// `(quantities · (s / kBatch) + q) · kBatch + s % kBatch`. The last batch is padded with copies of the last
/// simplex that have no volume and so no force.
///
/// X₀ … X_D are the rest corners. Dₘ has the columns X_a − X₀ in the simplex's own orthonormal frame, built
/// by Gram–Schmidt from these vectors; Dₘ and its inverse are upper triangular. Isotropic laws do not depend
/// on the frame, so a tetrahedron takes 56 bytes instead of 80. The frame of a tetrahedron is right-handed.
/// If its rest corners are in negative orientation, the last diagonal entry of Dₘ is negative. So for every
/// tetrahedron, det F > 0 means that it is not inverted. A simplex that is flat up to rounding errors gets
/// the volume 0 and Dₘ⁻¹ = 0. Volumes are never negative.
struct RestShapes {
  int dimension = 0;
  Offset count = 0;               ///< number of simplices
  AlignedVector<Index> vertices;  ///< D + 1 quantities: the corners
  AlignedVector<double>
      geometry;  ///< D(D + 1)/2 + 1 quantities: upper triangle of Dₘ⁻¹ row by row; volume (area, length)

  /// Returns the number of quantities in `geometry`.
  [[nodiscard]] int quantities() const noexcept { return dimension * (dimension + 1) / 2 + 1; }
  [[nodiscard]] Offset batches() const noexcept { return (count + kBatch - 1) / kBatch; }

  /// Returns corner `a` of simplex s; `volume` returns the volume of simplex s.
  [[nodiscard]] Index vertex(Offset s, Index a) const {
    return vertices[(s / kBatch * (dimension + 1) + a) * kBatch + s % kBatch];
  }
  [[nodiscard]] double volume(Offset s) const {
    return geometry[(s / kBatch * quantities() + quantities() - 1) * kBatch + s % kBatch];
  }
};

/// Returns the rest shapes of the simplices at the given points. O(simplices).
RestShapes rest_shapes(SimplicesRef simplices, std::span<const Point> points);

}  // namespace meshorder
