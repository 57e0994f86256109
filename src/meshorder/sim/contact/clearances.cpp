// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/contact/clearances.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "meshorder/sim/contact/clearances.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include <meshorder/sim/kernels/lanes-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// The points whose clearance is not more than (deviation + apart) · factor.
std::uint64_t points_in_doubt(const float* clearances, const float* deviations, float apart, float factor) {
  const hn::CappedTag<float, kLeaf> d;
  constexpr Index kFloats = static_cast<Index>(MaxLanes(hn::CappedTag<float, kLeaf>()));
  std::uint64_t result = 0;
  for (Index i = 0; i < PointCluster::kMost; i += kFloats) {
    const auto moved = hn::Mul(hn::Add(hn::Load(d, deviations + i), hn::Set(d, apart)), hn::Set(d, factor));
    const auto known = hn::Gt(hn::Load(d, clearances + i), moved);  // not where one is NaN
    alignas(8) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, known, bytes);
    for (Index byte = 0; 8 * byte < kFloats; ++byte)
      result |= std::uint64_t{bytes[byte]} << static_cast<unsigned>(i + 8 * byte);
  }
  return ~result;
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <meshorder/base/parallel.hpp>
#include <meshorder/sim/contact/vectors.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <map>

namespace meshorder {
namespace {

HWY_EXPORT(points_in_doubt);

constexpr Index kClustersAtOnce = 8;

/// The mean side of the branches' boxes.
double mean_side(const TetrahedronLeaves& tetrahedra) {
  double sum = 0.0;
  for (Index branch = 0; branch < tetrahedra.branches; ++branch) {
    const float* const box =
        tetrahedra.branch_boxes.data() + Offset{6} * kLeaf * (branch / kLeaf) + branch % kLeaf;
    for (int c = 0; c < 3; ++c) sum += double{box[kLeaf * (3 + c)]} - double{box[kLeaf * c]};
  }
  return sum / (3.0 * std::max(tetrahedra.branches, Index{1}));
}

/// Of each cluster the branch that has most corners among its points.
std::vector<Index> frames_of(std::span<const PointCluster> clusters, const TetrahedronLeaves& tetrahedra,
                             Index vertex_count) {
  std::vector<Index> cluster_of(vertex_count, -1);
  for (Index c = 0; c < index_size(clusters); ++c) {
    for (const Index v : clusters[c].vertices) cluster_of[v] = c;
  }
  std::vector<Index> frames(clusters.size(), 0);
  std::vector<Index> most(clusters.size(), 0);
  for (Index branch = 0; branch < tetrahedra.branches; ++branch) {
    std::map<Index, Index> corners;
    const Offset first = Offset{4} * kLeaf * kLeaf * branch;
    for (Offset i = first; i < first + Offset{4} * kLeaf * tetrahedra.leaves_of(branch); ++i) {
      if (const Index c = cluster_of[tetrahedra.corners[i]]; c >= 0) ++corners[c];
    }
    for (const auto& [c, count] : corners) {
      if (count <= most[c]) continue;
      most[c] = count;
      frames[c] = branch;
    }
  }
  return frames;
}

/// The largest coordinate, of which floats round off a part.
double largest_coordinate(std::span<const Point> points) {
  double result = 0.0;
  for (const Point& p : points) result = std::max({result, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  return result;
}

bool meets_box(const PointCluster& cluster, const TetrahedronLeaves& tetrahedra, Index leaf) {
  const float* const box = tetrahedra.leaf_boxes.data() + Offset{6} * kLeaf * (leaf / kLeaf) + leaf % kLeaf;
  bool meets = true;
  for (int c = 0; c < 3; ++c)
    meets = meets && box[kLeaf * c] <= cluster.upper[c] && cluster.lower[c] <= box[kLeaf * (3 + c)];
  return meets;
}

/// The cluster with a box that reaches further on all sides.
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
  // further away nothing is known; nearly all that boxes meet in motion is nearer
  const auto margin = static_cast<float>(0.125 * mean_side(tetrahedra));
  const float known_margin = margin - static_cast<float>(largest_coordinate(rest) * 0x1p-21);
  const std::vector<Index> frames = frames_of(clusters, tetrahedra, index_size(rest));
  for_each_chunk(index_size(clusters), kClustersAtOnce, [&](Index /*chunk*/, Index begin, Index end) {
    for (Index c = begin; c < end; ++c) {
      Cluster& known = clusters_[c];
      known.frame = frames[c];
      update_points(clusters[c], positions);
      for (Index i = 0; i < PointCluster::kMost && tetrahedra.branches > 0; ++i) {
        const Point relative = minus(rest[clusters[c].vertices[i]], motions.center(known.frame));
        for (int axis = 0; axis < 3; ++axis) known.rest[PointCluster::kMost * axis + i] = relative[axis];
      }
      const PointCluster around = grown(clusters[c], margin);
      branches_at(tetrahedra, around, known.branches);
      known.clearances.assign(static_cast<std::size_t>(PointCluster::kMost) * known.branches.size(),
                              known_margin);
      for (std::size_t b = 0; b < known.branches.size(); ++b) {
        const Index first = kLeaf * known.branches[b];
        const std::span clearances(known.clearances.data() + PointCluster::kMost * b, PointCluster::kMost);
        for (Index leaf = first; leaf < first + tetrahedra.leaves_of(known.branches[b]); ++leaf) {
          if (meets_box(around, tetrahedra, leaf))
            lower_clearances(tetrahedra, around, {leaf, around.points}, positions, clearances);
        }
      }
    }
  });
}

void Clearances::update(Index c, const PointCluster& cluster, const BranchMotions& motions,
                        std::span<const double> positions) {
  Cluster& known = clusters_[c];
  motions.deviations(known.frame, cluster, known.rest, positions, known.deviations);
}

std::uint64_t Clearances::in_doubt(Index c, Index branch, const PointCluster& cluster,
                                   const BranchMotions& motions) const {
  const Cluster& known = clusters_[c];
  const auto place = std::lower_bound(known.branches.begin(), known.branches.end(), branch);
  if (place == known.branches.end() || *place != branch) return cluster.points;
  constexpr double kUp = 1.0 + 0x1p-20;  // more than floats' rounding errors
  const double apart = kUp * motions.apart(known.frame, branch);
  const double factor = kUp * motions.motion(known.frame).inverse_norm;
  const float* const clearances =
      known.clearances.data() + PointCluster::kMost * (place - known.branches.begin());
  return cluster.points & HWY_DYNAMIC_DISPATCH(points_in_doubt)(clearances, known.deviations.data(),
                                                                rounded_to_float(apart),
                                                                rounded_to_float(factor));
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
