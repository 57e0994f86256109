// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/clearances.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/contact/search/clearances.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/lanes-inl.hpp"
#include "lab/contact/search/lane_bits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

using Doubles = hn::CappedTag<double, kBatch>;
constexpr Index kDoubles = static_cast<Index>(MaxLanes(Doubles()));

/// Returns the points that may be inside: those whose clearance is at most ‖inverse map‖ (d + e), where d is
/// the distance of the point from its image under the affine motion, and e the deviation of the branch's
/// corners.
std::uint64_t points_in_doubt(const PointCluster& cluster, const double* rest, const float* clearances,
                              const BranchMotions::Motion& motion) {
  const Doubles d;
  const hn::Rebind<float, Doubles> floats;
  std::uint64_t known = 0;
  for (Index i = 0; i < PointCluster::kMaxPoints; i += kDoubles) {
    auto square = hn::Zero(d);
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      auto apart = hn::Sub(hn::Load(d, cluster.positions[c].data() + i), hn::Set(d, motion.constant[c]));
      MESHORDER_UNROLL
      for (int k = 0; k < 3; ++k)
        apart = hn::NegMulAdd(hn::Set(d, motion.columns[k][c]),
                              hn::Load(d, rest + PointCluster::kMaxPoints * k + i), apart);
      square = hn::MulAdd(apart, apart, square);
    }
    const auto moved =
        hn::Mul(hn::Set(d, motion.inverse_norm), hn::Add(hn::Sqrt(square), hn::Set(d, motion.deviation)));
    // false if a number is NaN
    const auto less = hn::Lt(moved, hn::PromoteTo(d, hn::Load(floats, clearances + i)));
    known |= std::uint64_t{bits_of(d, less)} << static_cast<unsigned>(i);
  }
  return ~known;
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/parallel.hpp"
#include "base/point.hpp"
#include "kernels/simd_dispatch.hpp"
#include "lab/contact/search/leaf_planes.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(points_in_doubt);

constexpr Index kClustersAtOnce = 8;

/// Returns the mean side of the branches' boxes.
double mean_side(const TetrahedronLeaves& tetrahedra) {
  double sum = 0.0;
  for (Index branch = 0; branch < tetrahedra.branches; ++branch) {
    const float* const box = tetrahedra.branch_box(branch);
    for (int c = 0; c < 3; ++c) sum += double{box[kLeaf * (3 + c)]} - double{box[kLeaf * c]};
  }
  return sum / (3.0 * std::max(tetrahedra.branches, Index{1}));
}

/// Returns the largest absolute coordinate, to which the rounding errors of floats are relative.
double largest_coordinate(std::span<const Point> points) {
  double result = 0.0;
  for (const Point& p : points) result = std::max({result, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  return result;
}

bool meets_box(const PointCluster& cluster, const TetrahedronLeaves& tetrahedra, Index leaf) {
  const float* const box = tetrahedra.leaf_box(leaf);
  bool meets = true;
  for (int c = 0; c < 3; ++c)
    meets = meets && box[kLeaf * c] <= cluster.upper[c] && cluster.lower[c] <= box[kLeaf * (3 + c)];
  return meets;
}

/// Returns the cluster with its box extended by `margin` on all sides.
PointCluster grown(PointCluster cluster, float margin) {
  for (int c = 0; c < 3; ++c) {
    cluster.lower[c] -= margin;
    cluster.upper[c] += margin;
  }
  return cluster;
}

}  // namespace

Clearances::Clearances(TetrahedronLeaves& tetrahedra, BranchMotions& motions,
                       std::span<PointCluster> clusters, std::span<const Point> rest)
    : clusters_(clusters.size()) {
  const AlignedVector<double> positions = padded_positions(rest);
  for (Index branch = 0; branch < tetrahedra.branches; ++branch) {
    motions.update(branch, positions, tetrahedra);
    update_boxes(tetrahedra, branch, positions);
  }
  for (Index leaf = 0; leaf < tetrahedra.leaves; ++leaf) update_planes(tetrahedra, leaf, positions);
  // branches further away get no clearances; few of them meet the cluster's box in motion
  const auto margin = static_cast<float>(0.125 * mean_side(tetrahedra));
  const float known_margin = margin - static_cast<float>(largest_coordinate(rest) * 0x1p-21);
  for_each_chunk(index_size(clusters), kClustersAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index c = begin; c < end; ++c) {
      Cluster& known = clusters_[c];
      update_points(clusters[c], positions);
      known.rest = clusters[c].positions;
      const PointCluster around = grown(clusters[c], margin);
      branches_at(tetrahedra, around, known.branches);
      known.clearances.assign(static_cast<std::size_t>(PointCluster::kMaxPoints) * known.branches.size(),
                              known_margin);
      for (std::size_t b = 0; b < known.branches.size(); ++b) {
        const Index first = kBranch * known.branches[b];
        const std::span clearances(known.clearances.data() + PointCluster::kMaxPoints * b,
                                   PointCluster::kMaxPoints);
        for (Index leaf = first; leaf < first + tetrahedra.leaves_of(known.branches[b]); ++leaf) {
          if (meets_box(around, tetrahedra, leaf))
            lower_clearances(tetrahedra, around, {leaf, around.points}, positions, clearances);
        }
      }
    }
  });
}

std::uint64_t Clearances::in_doubt(Index c, Index branch, const PointCluster& cluster,
                                   const BranchMotions& motions) const {
  const Cluster& known = clusters_[c];
  const auto place = std::lower_bound(known.branches.begin(), known.branches.end(), branch);
  if (place == known.branches.end() || *place != branch) return cluster.points;
  const float* const clearances =
      known.clearances.data() + PointCluster::kMaxPoints * (place - known.branches.begin());
  return cluster.points &
         MESHORDER_SIMD(points_in_doubt)(cluster, known.rest[0].data(), clearances, motions.motion(branch));
}

std::size_t Clearances::bytes() const {
  std::size_t sum = clusters_.capacity() * sizeof(Cluster);
  for (const Cluster& c : clusters_) {
    sum += c.branches.capacity() * sizeof(Index) + c.clearances.capacity() * sizeof(float);
  }
  return sum;
}

}  // namespace meshorder
#endif
