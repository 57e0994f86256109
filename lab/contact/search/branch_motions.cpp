// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/branch_motions.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/contact/search/branch_motions.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/lanes-inl.hpp"

#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

using Corner = BranchMotions::Corner;
using Shape = BranchMotions::Shape;
using Motion = BranchMotions::Motion;

/// A padded vertex in as many registers as it takes.
using RowTag = hn::CappedTag<double, kPaddedStride>;
constexpr Index kParts = kPaddedStride / static_cast<Index>(MaxLanes(RowTag()));

struct Padded {
  hn::Vec<RowTag> parts[kParts];

  static HWY_INLINE Padded load(const double* from) {
    Padded result;
    MESHORDER_UNROLL
    for (Index i = 0; i < kParts; ++i)
      result.parts[i] = hn::Load(RowTag(), from + i * (kPaddedStride / kParts));
    return result;
  }
  static HWY_INLINE Padded set(double value) {
    Padded result;
    for (hn::Vec<RowTag>& part : result.parts) part = hn::Set(RowTag(), value);
    return result;
  }
  HWY_INLINE void store(double* to) const {
    MESHORDER_UNROLL
    for (Index i = 0; i < kParts; ++i) hn::Store(parts[i], RowTag(), to + i * (kPaddedStride / kParts));
  }
  /// Returns this + factor · other.
  HWY_INLINE Padded plus(double factor, const Padded& other) const {
    Padded result;
    MESHORDER_UNROLL
    for (Index i = 0; i < kParts; ++i)
      result.parts[i] = hn::MulAdd(hn::Set(RowTag(), factor), other.parts[i], parts[i]);
    return result;
  }
  /// Replaces each number by that of `other` if that is smaller (raise_to: larger). A NaN replaces nothing.
  HWY_INLINE void lower_to(const Padded& other) {
    MESHORDER_UNROLL
    for (Index i = 0; i < kParts; ++i)
      parts[i] = hn::IfThenElse(hn::Lt(other.parts[i], parts[i]), other.parts[i], parts[i]);
  }
  HWY_INLINE void raise_to(const Padded& other) {
    MESHORDER_UNROLL
    for (Index i = 0; i < kParts; ++i)
      parts[i] = hn::IfThenElse(hn::Gt(other.parts[i], parts[i]), other.parts[i], parts[i]);
  }
  HWY_INLINE Padded magnitude() const {
    Padded result;
    MESHORDER_UNROLL
    for (Index i = 0; i < kParts; ++i) result.parts[i] = hn::Abs(parts[i]);
    return result;
  }
};

/// Fits an affine map to the corners' motion by least squares. Sets lower_end and upper_end to the padded
/// ends of the box around the corners.
void fit_motion(std::span<const Corner> corners, const Shape& shape, const double* positions, Motion& motion,
                double* lower_end, double* upper_end) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto position = [&](const Corner& corner) {
    return Padded::load(positions + Offset{kPaddedStride} * corner.vertex);
  };
  const Padded origin = position(corners.front());
  Padded lower = Padded::set(infinity);
  Padded upper = Padded::set(-infinity);
  Padded sum = Padded::set(0.0);
  Padded moments[3] = {sum, sum, sum};
  for (const Corner& corner : corners) {
    const Padded x = position(corner);
    lower.lower_to(x);
    upper.raise_to(x);
    const Padded from_origin = x.plus(-1.0, origin);
    sum = sum.plus(1.0, from_origin);
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) moments[k] = moments[k].plus(static_cast<double>(corner.at[k]), from_origin);
  }
  const Padded mean = Padded::set(0.0).plus(1.0 / static_cast<double>(corners.size()), sum);
  Padded columns[3];
  for (int j = 0; j < 3; ++j) {
    columns[j] = Padded::set(0.0);
    for (int k = 0; k < 3; ++k) columns[j] = columns[j].plus(shape.inverse_moments[k][j], moments[k]);
    columns[j].store(motion.columns[j].data());
  }
  const Padded translation = mean.plus(1.0, origin);
  Padded worst = Padded::set(0.0);
  for (const Corner& corner : corners) {
    Padded apart = position(corner).plus(-1.0, translation);
    MESHORDER_UNROLL
    for (int k = 0; k < 3; ++k) apart = apart.plus(-static_cast<double>(corner.at[k]), columns[k]);
    worst.raise_to(apart.magnitude());
  }
  translation.store(motion.constant.data());
  lower.store(lower_end);
  upper.store(upper_end);
  alignas(64) double apart[kPaddedStride];
  worst.store(apart);
  motion.deviation = std::sqrt(apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2]);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/positions.hpp"
#include "kernels/simd_dispatch.hpp"

#include <algorithm>

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(fit_motion);

using Matrix = std::array<std::array<double, 3>, 3>;

/// Returns the inverse; NaN or infinite if the matrix is singular.
Matrix inverse(const Matrix& m) {
  Matrix result{};
  const Point first = cross(m[1], m[2]);
  const double determinant = dot(m[0], first);
  const std::array<Point, 3> columns{first, cross(m[2], m[0]), cross(m[0], m[1])};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[i][j] = columns[j][i] / determinant;
  }
  return result;
}

double frobenius(const Matrix& m) { return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2])); }

/// Returns an upper bound of the spectral norm from the rows of m mᵀ, close for nearly orthogonal matrices.
double norm_bound(const Matrix& m) {
  double square = 0.0;
  for (int i = 0; i < 3; ++i) {
    double row = 0.0;
    for (int j = 0; j < 3; ++j) row += std::abs(dot(m[i], m[j]));
    if (row > square || std::isnan(row)) square = row;
  }
  return std::sqrt(square);
}

/// Returns the columns of the linear part.
Matrix linear_part(const BranchMotions::Motion& motion) {
  Matrix result{};
  for (int k = 0; k < 3; ++k) std::copy_n(motion.columns[k].begin(), 3, result[k].begin());
  return result;
}

}  // namespace

BranchMotions::BranchMotions(const TetrahedronLeaves& tetrahedra, std::span<const Point> rest)
    : shapes_(tetrahedra.branches), motions_(tetrahedra.branches) {
  std::vector<Index> vertices;
  for (Index branch = 0; branch < tetrahedra.branches; ++branch) {
    const auto first = tetrahedra.corners.begin() + Offset{4} * kLeaf * kBranch * branch;
    vertices.assign(first, first + Offset{4} * kLeaf * tetrahedra.leaves_of(branch));
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    Shape& shape = shapes_[branch];
    for (const Index v : vertices)
      shape.center = plus_scaled(shape.center, 1.0 / static_cast<double>(vertices.size()), rest[v]);
    Matrix moments{};
    for (const Index v : vertices) {
      const Point from_center = minus(rest[v], shape.center);
      shape.radius = std::max(shape.radius, norm(from_center));
      Corner corner{{}, v};
      for (int c = 0; c < 3; ++c) {
        corner.at[c] = static_cast<float>(from_center[c]);
        for (int d = 0; d < 3; ++d) moments[c][d] += from_center[c] * from_center[d];
      }
      corners_.push_back(corner);
    }
    shape.inverse_moments = inverse(moments);
    offsets_.push_back(static_cast<Offset>(corners_.size()));
  }
}

void BranchMotions::update(Index branch, std::span<const double> positions, TetrahedronLeaves& tetrahedra) {
  const std::span<const Corner> corners(corners_.data() + offsets_[branch],
                                        corners_.data() + offsets_[branch + 1]);
  Motion& motion = motions_[branch];
  alignas(64) std::array<double, kPaddedStride> lower{};
  alignas(64) std::array<double, kPaddedStride> upper{};
  MESHORDER_SIMD(fit_motion)
  (corners, shapes_[branch], positions.data(), motion, lower.data(), upper.data());
  const Matrix columns = linear_part(motion);
  motion.inverse_norm = norm_bound(inverse(columns));
  // so far the constant is the image of the centre
  constexpr double kRoundedCorners = 1e-6;  // corners are rounded to floats
  constexpr double kRoundedPositions = 1e-13;
  const Shape& shape = shapes_[branch];
  motion.deviation += kRoundedCorners * frobenius(columns) * shape.radius;
  for (int c = 0; c < 3; ++c) {
    motion.deviation += kRoundedPositions * std::abs(motion.constant[c]);
    for (int k = 0; k < 3; ++k) {
      motion.constant[c] -= columns[k][c] * shape.center[k];
      motion.deviation += kRoundedPositions * std::abs(columns[k][c] * shape.center[k]);
    }
  }
  float* const box = tetrahedra.branch_boxes.data() + Offset{6} * kLeaf * (branch / kLeaf) + branch % kLeaf;
  for (int c = 0; c < 3; ++c) {
    box[kLeaf * c] = rounded_to_float(lower[c]);
    box[kLeaf * (3 + c)] = rounded_to_float(upper[c]);
  }
}

std::size_t BranchMotions::bytes() const {
  return offsets_.capacity() * sizeof(Offset) + corners_.capacity() * sizeof(Corner) +
         shapes_.capacity() * sizeof(Shape) + motions_.capacity() * sizeof(Motion);
}

}  // namespace meshorder
#endif
