// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <array>
#include <span>
#include <vector>

namespace meshorder {

/// The motion of each branch of tetrahedra from rest, as an affine map and a bound of the deviation from the
/// map. An affine map keeps points inside or outside of tetrahedra.
class BranchMotions {
 public:
  /// The affine map constant + columns · X. A corner at X at rest is within `deviation` of its image.
  struct Motion {
    alignas(64) std::array<std::array<double, 4>, 3> columns{};  ///< the fourth of each is 0
    std::array<double, 4> constant{};
    double deviation = 0.0;  ///< including rounding errors
    /// At least the norm of the inverse matrix; not finite if there is no inverse.
    double inverse_norm = 0.0;
  };

  BranchMotions(const TetrahedronLeaves& tetrahedra, std::span<const Point> rest);

  /// Fits the motion of the branch to `positions`; sets the branch's box. O(tetrahedra of the branch).
  void update(Index branch, std::span<const double> positions, TetrahedronLeaves& tetrahedra);

  [[nodiscard]] const Motion& motion(Index branch) const { return motions_[branch]; }
  /// Returns the memory held, in bytes.
  [[nodiscard]] std::size_t bytes() const;

  /// A corner relative to the branch's centre, rounded.
  struct Corner {
    std::array<float, 3> at{};
    Index vertex = 0;
  };
  struct Shape {
    Point center{};
    double radius = 0.0;
    std::array<std::array<double, 3>, 3>
        inverse_moments{};  ///< of Σ (X − center)(X − center)ᵀ; NaN if singular
  };

 private:
  std::vector<Offset> offsets_{0};
  AlignedVector<Corner> corners_;  ///< of each branch, each corner once
  std::vector<Shape> shapes_;
  std::vector<Motion> motions_;
};

}  // namespace meshorder
