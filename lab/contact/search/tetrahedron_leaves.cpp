// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/search/tetrahedron_leaves.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/contact/search/tetrahedron_leaves.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "kernels/lanes-inl.hpp"
#include "lab/contact/search/lane_bits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// Returns the smaller number in each lane, `a` where b is NaN.
template <class Value>
HWY_INLINE Value lesser(Value a, Value b) {
  return ManyLanes::choose(a - b, b, a);
}

template <class Value>
HWY_INLINE Value greater(Value a, Value b) {
  return ManyLanes::choose(b - a, b, a);
}

HWY_INLINE double min_lane(ManyLanes::Value value) {
  alignas(64) double lanes[kBatch];
  ManyLanes::store(value, lanes);
  return *std::min_element(lanes, lanes + ManyLanes::kCount);
}
HWY_INLINE double greatest_lane(ManyLanes::Value value) {
  alignas(64) double lanes[kBatch];
  ManyLanes::store(value, lanes);
  return *std::max_element(lanes, lanes + ManyLanes::kCount);
}

/// Extends the box of each lane by the corners of its tetrahedron, beginning with lane `lane` of the leaf.
HWY_INLINE void corner_boxes(const Index* corners, const double* positions, Index lane,
                             ManyLanes::Value (&lower)[3], ManyLanes::Value (&upper)[3]) {
  for (int k = 0; k < 4; ++k) {
    ManyLanes::Value p[3];
    ManyLanes::gather(positions, corners + kLeaf * k + lane, p);
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      lower[c] = lesser(lower[c], p[c]);
      upper[c] = greater(upper[c], p[c]);
    }
  }
}

void boxes_of_branch(TetrahedronLeaves& tetrahedra, Index branch, const double* positions) {
  const double infinity = std::numeric_limits<double>::infinity();
  float* const boxes = tetrahedra.leaf_boxes.data() + Offset{6} * kLeaf * branch;
  const Index count = tetrahedra.leaves_of(branch);
  for (Index l = 0; l < count; ++l) {
    const Index* const corners = tetrahedra.corners.data() + Offset{4} * kLeaf * (kBranch * branch + l);
    ManyLanes::Value lower[3];
    ManyLanes::Value upper[3];
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      lower[c] = ManyLanes::set(infinity);
      upper[c] = ManyLanes::set(-infinity);
    }
    for (Index lane = 0; lane < kLeaf; lane += ManyLanes::kCount)
      corner_boxes(corners, positions, lane, lower, upper);
    for (int c = 0; c < 3; ++c) {
      boxes[kLeaf * c + l] = rounded_to_float(min_lane(lower[c]));
      boxes[kLeaf * (3 + c) + l] = rounded_to_float(greatest_lane(upper[c]));
    }
  }
}

void read_points(PointCluster& cluster, const double* positions) {
  const double infinity = std::numeric_limits<double>::infinity();
  ManyLanes::Value lower[3];
  ManyLanes::Value upper[3];
  MESHORDER_UNROLL
  for (int c = 0; c < 3; ++c) {
    lower[c] = ManyLanes::set(infinity);
    upper[c] = ManyLanes::set(-infinity);
  }
  for (Index i = 0; i < PointCluster::kMaxPoints; i += ManyLanes::kCount) {
    ManyLanes::Value p[3];
    ManyLanes::gather(positions, cluster.vertices.data() + i, p);
    MESHORDER_UNROLL
    for (int c = 0; c < 3; ++c) {
      lower[c] = lesser(lower[c], p[c]);
      upper[c] = greater(upper[c], p[c]);
      ManyLanes::store(p[c], cluster.positions[c].data() + i);
    }
  }
  for (int c = 0; c < 3; ++c) {
    for (Index i = 0; i < PointCluster::kMaxPoints; ++i)
      cluster.coordinates[c][i] = rounded_to_float(cluster.positions[c][i]);
    cluster.lower[c] = rounded_to_float(min_lane(lower[c]));
    cluster.upper[c] = rounded_to_float(greatest_lane(upper[c]));
  }
}

/// Returns which of sixteen boxes meet a box, as bits.
HWY_INLINE std::uint32_t meeting(const float* boxes, const std::array<float, 3>& lower,
                                 const std::array<float, 3>& upper) {
  const Floats d;
  std::uint32_t result = 0;
  for (Index lane = 0; lane < kLeaf; lane += kFloats) {
    const auto overlap = [&](int c) {
      return hn::And(hn::Le(hn::Load(d, boxes + kLeaf * c + lane), hn::Set(d, upper[c])),
                     hn::Le(hn::Set(d, lower[c]), hn::Load(d, boxes + kLeaf * (3 + c) + lane)));
    };
    const auto meets = hn::And(overlap(0), hn::And(overlap(1), overlap(2)));
    result |= bits_of(d, meets) << static_cast<unsigned>(lane);
  }
  return result;
}

void branches_meeting(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster,
                      std::vector<Index>& branches) {
  branches.clear();
  for (Index first = 0; first < tetrahedra.branches; first += kLeaf) {
    std::uint32_t met =
        meeting(tetrahedra.branch_boxes.data() + Offset{6} * first, cluster.lower, cluster.upper);
    for (; met != 0; met &= met - 1) branches.push_back(first + std::countr_zero(met));
  }
}

void leaves_meeting(const TetrahedronLeaves& tetrahedra, Index branch, const PointCluster& cluster,
                    std::uint64_t points, std::vector<LeafTask>& tasks) {
  const Floats d;
  const float* const boxes = tetrahedra.leaf_boxes.data() + Offset{6} * kLeaf * branch;
  std::uint32_t met = meeting(boxes, cluster.lower, cluster.upper);
  for (; met != 0; met &= met - 1) {
    const Index leaf = std::countr_zero(met);
    std::uint64_t inside = 0;
    for (Index lane = 0; lane < PointCluster::kMaxPoints; lane += kFloats) {
      const auto between = [&](int c) {
        const auto x = hn::Load(d, cluster.coordinates[c].data() + lane);
        return hn::And(hn::Le(hn::Set(d, boxes[kLeaf * c + leaf]), x),
                       hn::Le(x, hn::Set(d, boxes[kLeaf * (3 + c) + leaf])));
      };
      const auto in = hn::And(between(0), hn::And(between(1), between(2)));
      inside |= std::uint64_t{bits_of(d, in)} << static_cast<unsigned>(lane);
    }
    inside &= points;
    if (inside != 0) tasks.push_back({kBranch * branch + leaf, inside});
  }
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(boxes_of_branch);
MESHORDER_SIMD_VERSIONS(branches_meeting);
MESHORDER_SIMD_VERSIONS(leaves_meeting);
MESHORDER_SIMD_VERSIONS(read_points);

}  // namespace

TetrahedronLeaves::TetrahedronLeaves(std::span<const std::array<Index, 4>> tetrahedra,
                                     std::span<const Index> tetrahedron_numbers)
    : leaves((index_size(tetrahedra) + kLeaf - 1) / kLeaf), branches((leaves + kBranch - 1) / kBranch) {
  corners.resize(Offset{4} * kLeaf * leaves);
  numbers.assign(Offset{kLeaf} * leaves, -1);
  centers.resize(leaves);
  planes.resize(Offset{16} * kLeaf * leaves);
  for (Offset i = 0; i < Offset{kLeaf} * leaves; ++i) {
    const bool real = i < static_cast<Offset>(tetrahedra.size());
    const std::array<Index, 4>& tetrahedron = real ? tetrahedra[i] : tetrahedra.back();
    for (int k = 0; k < 4; ++k) corners[kLeaf * (4 * (i / kLeaf) + k) + i % kLeaf] = tetrahedron[k];
    if (real) numbers[i] = tetrahedron_numbers[i];
  }
  // empty boxes for the lanes without a leaf or branch
  const auto fill_up = [](AlignedVector<float>& boxes, Index groups) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    boxes.resize(Offset{6} * kLeaf * groups);
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = i / kLeaf % 6 < 3 ? kInfinity : -kInfinity;
  };
  fill_up(leaf_boxes, branches);
  fill_up(branch_boxes, (branches + kLeaf - 1) / kLeaf);
}

std::size_t TetrahedronLeaves::bytes() const {
  return corners.capacity() * sizeof(Index) + numbers.capacity() * sizeof(Index) +
         leaf_boxes.capacity() * sizeof(float) + branch_boxes.capacity() * sizeof(float) +
         centers.capacity() * sizeof(centers[0]) + planes.capacity() * sizeof(float);
}

void update_boxes(TetrahedronLeaves& tetrahedra, Index branch, std::span<const double> positions) {
  MESHORDER_SIMD(boxes_of_branch)(tetrahedra, branch, positions.data());
}

PointCluster::PointCluster(std::span<const Index> some)
    : points(~std::uint64_t{0} >> (kMaxPoints - some.size())) {
  std::fill(std::copy(some.begin(), some.end(), vertices.begin()), vertices.end(), some.back());
}

void update_points(PointCluster& cluster, std::span<const double> positions) {
  MESHORDER_SIMD(read_points)(cluster, positions.data());
}

void branches_at(const TetrahedronLeaves& tetrahedra, const PointCluster& cluster,
                 std::vector<Index>& branches) {
  MESHORDER_SIMD(branches_meeting)(tetrahedra, cluster, branches);
}

void leaves_at(const TetrahedronLeaves& tetrahedra, Index branch, const PointCluster& cluster,
               std::uint64_t points, std::vector<LeafTask>& tasks) {
  MESHORDER_SIMD(leaves_meeting)(tetrahedra, branch, cluster, points, tasks);
}

}  // namespace meshorder
#endif
