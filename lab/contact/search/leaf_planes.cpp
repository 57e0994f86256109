// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/leaf_planes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/contact/search/leaf_planes.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/lanes-inl.hpp"
#include "lab/contact/search/lane_bits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// Computes normal = (b − a) × (c − a); it points to the side from which a, b, c are counterclockwise.
template <class Value>
HWY_INLINE void plane_through(const Value (&a)[3], const Value (&b)[3], const Value (&c)[3],
                              Value (&normal)[3]) {
  Value u[3];
  Value v[3];
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    v[i] = c[i] - a[i];
  }
  MESHORDER_UNROLL
  for (int i = 0; i < 3; ++i) normal[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

void planes_of_leaf(TetrahedronLeaves& tetrahedra, Index leaf, const double* positions) {
  // corners of the face opposite each corner, counterclockwise seen from inside the tetrahedron
  constexpr int kInward[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  // bound of rounding errors in a height: three products of a rounded normal and a rounded point
  constexpr double kPlaneRounding = 32 * 0x1p-24;
  constexpr double kTooLarge = 1e30;
  using Value = ManyLanes::Value;
  const Index* const corners = tetrahedra.corners.data() + Offset{4} * kLeaf * leaf;
  const float* const box = tetrahedra.leaf_box(leaf);
  std::array<double, 3>& center = tetrahedra.centers[leaf];
  double radius = 0.0;  // the sum of half the sides: more than half the diagonal
  for (int c = 0; c < 3; ++c) {
    const double lower = box[kLeaf * c];
    const double upper = box[kLeaf * (3 + c)];
    center[c] = 0.5 * (lower + upper);
    radius += 0.5 * (upper - lower) + std::abs(center[c]) * 0x1p-23;  // the ends are rounded
  }
  float* const planes = tetrahedra.planes.data() + Offset{16} * kLeaf * leaf;
  if (!(radius < kTooLarge)) {
    // the leaf is too large for floats: its planes exclude no point
    center = {};
    for (Index i = 0; i < 16 * kLeaf; ++i) planes[i] = i / kLeaf % 4 < 3 ? 0.0F : 1.0F;
    return;
  }
  for (Index lane = 0; lane < kLeaf; lane += ManyLanes::kCount) {
    Value p[4][3];
    MESHORDER_UNROLL
    for (int k = 0; k < 4; ++k) {
      ManyLanes::gather(positions, corners + kLeaf * k + lane, p[k]);
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) p[k][c] = p[k][c] - ManyLanes::set(center[c]);
    }
    MESHORDER_UNROLL
    for (int k = 0; k < 4; ++k) {
      const Value(&a)[3] = p[kInward[k][0]];
      Value normal[3];
      plane_through(a, p[kInward[k][1]], p[kInward[k][2]], normal);
      const Value size = ManyLanes::abs(normal[0]) + ManyLanes::abs(normal[1]) + ManyLanes::abs(normal[2]);
      const Value through = normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2];
      // normals whose absolute coordinates add up to 1; NaN if there is no plane
      const Value scale = ManyLanes::set(1.0) / size;
      alignas(64) double numbers[4][kBatch];
      MESHORDER_UNROLL
      for (int c = 0; c < 3; ++c) ManyLanes::store(normal[c] * scale, numbers[c]);
      ManyLanes::store(ManyLanes::set(kPlaneRounding * radius) - through * scale, numbers[3]);
      for (int q = 0; q < 4; ++q) {
        float* const to = planes + kLeaf * (4 * k + q) + lane;
        for (Index i = 0; i < ManyLanes::kCount; ++i) to[i] = static_cast<float>(numbers[q][i]);
      }
    }
  }
}

using FloatVector = hn::Vec<Floats>;
using Integers = hn::RebindToSigned<Floats>;
using IntegerVector = hn::Vec<Integers>;

/// The planes and corners of as many tetrahedra of a leaf as a register holds.
struct LeafLanes {
  FloatVector planes[4][4];
  IntegerVector corners[4];

  HWY_INLINE LeafLanes(const TetrahedronLeaves& tetrahedra, Index leaf, Index lane) {
    const float* const plane = tetrahedra.planes.data() + Offset{16} * kLeaf * leaf + lane;
    const Index* const corner = tetrahedra.corners.data() + Offset{4} * kLeaf * leaf + lane;
    MESHORDER_UNROLL
    for (int k = 0; k < 4; ++k) {
      MESHORDER_UNROLL
      for (int q = 0; q < 4; ++q) planes[k][q] = hn::Load(Floats(), plane + kLeaf * (4 * k + q));
      corners[k] = hn::Load(Integers(), corner + kLeaf * k);
    }
  }

  /// Returns, for each tetrahedron, the smallest height of the point over the four planes.
  HWY_INLINE FloatVector height(float x, float y, float z) const {
    const Floats d;
    const FloatVector p[3] = {hn::Set(d, x), hn::Set(d, y), hn::Set(d, z)};
    const auto over = [&](int k) {
      return hn::MulAdd(planes[k][0], p[0],
                        hn::MulAdd(planes[k][1], p[1], hn::MulAdd(planes[k][2], p[2], planes[k][3])));
    };
    return hn::Min(hn::Min(over(0), over(1)), hn::Min(over(2), over(3)));
  }

  HWY_INLINE auto has_corner(Index vertex) const {
    const IntegerVector v = hn::Set(Integers(), vertex);
    return hn::RebindMask(Floats(), hn::Or(hn::Or(hn::Eq(corners[0], v), hn::Eq(corners[1], v)),
                                           hn::Or(hn::Eq(corners[2], v), hn::Eq(corners[3], v))));
  }
};

/// The points of a task, relative to the leaf's centre.
struct TaskPoints {
  Index count = 0;
  Index points[PointCluster::kMaxPoints];
  Index vertices[PointCluster::kMaxPoints];
  float at[3][PointCluster::kMaxPoints];

  HWY_INLINE TaskPoints(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster,
                        const LeafTask& task, const double* positions) {
    const std::array<double, 3>& center = tetrahedra.centers[task.leaf];
    for (std::uint64_t left = task.points; left != 0; left &= left - 1) {
      points[count] = std::countr_zero(left);
      vertices[count] = cluster.vertices[points[count]];
      const double* const position = positions + Offset{kPaddedStride} * vertices[count];
      for (int c = 0; c < 3; ++c) at[c][count] = rounded_to_float(position[c] - center[c]);
      ++count;
    }
  }
};

void hits_of_task(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
                  const double* positions, std::vector<LeafHit>& hits) {
  const Floats d;
  const TaskPoints task_points(tetrahedra, cluster, task, positions);
  std::uint32_t lanes[PointCluster::kMaxPoints] = {};
  for (Index lane = 0; lane < kLeaf; lane += kFloats) {
    const LeafLanes leaf(tetrahedra, task.leaf, lane);
    for (Index i = 0; i < task_points.count; ++i) {
      const FloatVector height =
          leaf.height(task_points.at[0][i], task_points.at[1][i], task_points.at[2][i]);
      const auto inside =
          hn::And(hn::Ge(height, hn::Zero(d)), hn::Not(leaf.has_corner(task_points.vertices[i])));
      lanes[i] |= bits_of(d, inside) << static_cast<unsigned>(lane);
    }
  }
  for (Index i = 0; i < task_points.count; ++i) {
    if (lanes[i] != 0) hits.push_back({task_points.points[i], task.leaf, lanes[i]});
  }
}

void clearances_of_task(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster,
                        const LeafTask& task, const double* positions, float* clearances) {
  const Floats d;
  const TaskPoints task_points(tetrahedra, cluster, task, positions);
  for (Index lane = 0; lane < kLeaf; lane += kFloats) {
    const LeafLanes leaf(tetrahedra, task.leaf, lane);
    for (Index i = 0; i < task_points.count; ++i) {
      const FloatVector height =
          leaf.height(task_points.at[0][i], task_points.at[1][i], task_points.at[2][i]);
      const FloatVector none = hn::Set(d, std::numeric_limits<float>::lowest());
      const FloatVector others = hn::IfThenElse(leaf.has_corner(task_points.vertices[i]), none, height);
      const Index point = task_points.points[i];
      clearances[point] = std::min(clearances[point], -hn::GetLane(hn::MaxOfLanes(d, others)));
    }
  }
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(planes_of_leaf);
MESHORDER_SIMD_VERSIONS(hits_of_task);
MESHORDER_SIMD_VERSIONS(clearances_of_task);

}  // namespace

void update_planes(TetrahedronLeaves& tetrahedra, Index leaf, std::span<const double> positions) {
  MESHORDER_SIMD(planes_of_leaf)(tetrahedra, leaf, positions.data());
}

void lower_clearances(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
                      std::span<const double> positions, std::span<float> clearances) {
  MESHORDER_SIMD(clearances_of_task)(tetrahedra, cluster, task, positions.data(), clearances.data());
}

void hits_of(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster, const LeafTask& task,
             std::span<const double> positions, std::vector<LeafHit>& hits) {
  MESHORDER_SIMD(hits_of_task)(tetrahedra, cluster, task, positions.data(), hits);
}

}  // namespace meshorder
#endif
