// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/springs.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/springs.cpp"
#include <hwy/foreach_target.h>
// the rest of this file is compiled once for each instruction set
#include "kernels/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

/// Computes a batch of springs and adds its forces to `targets`: the ends of the springs, some of them
/// replaced by spare vertices.
template <class Lanes>
HWY_INLINE void add_batch(const double* rest_length, const Index* ends, const Index* targets,
                          double stiffness, const double* positions, double* forces) {
  using Value = typename Lanes::Value;
  const Value k = Lanes::set(stiffness);
  for (Index first = 0; first < kBatch; first += Lanes::kCount) {
    Value rows[Lanes::kCount][Lanes::kRegisters];
    MESHORDER_UNROLL
    for (Index i = 0; i < Lanes::kCount; ++i)
      Lanes::difference(positions, ends[first + i], ends[kBatch + first + i], rows[i]);
    const Value length = Lanes::square_root(Lanes::squared_lengths(rows));
    alignas(64) double scales[Lanes::kCount];
    Lanes::store(Lanes::if_positive(length, k - k * Lanes::load(rest_length + first) / length), scales);
    MESHORDER_UNROLL
    for (Index i = 0; i < Lanes::kCount; ++i) {
      MESHORDER_UNROLL
      for (Value& of_row : rows[i]) of_row = Lanes::set(scales[i]) * of_row;
      Lanes::add(rows[i], forces, targets[first + i]);
      Lanes::subtract(rows[i], forces, targets[kBatch + first + i]);
    }
  }
}

/// Prefetches the data of later batches in the arrays that are read from front to back: the springs, and the
/// vertices after the larger ends of this batch (springs are sorted by their larger ends).
HWY_INLINE void fetch_streams(const double* rest_length, const Index* ends, const double* positions,
                              const double* forces) {
  constexpr Offset kBatches = 16;
  constexpr Offset kVertices = 48;
  fetch_stream<sizeof(double) * kBatch>(rest_length + kBatches * kBatch);
  fetch_stream<sizeof(Index) * 2 * kBatch>(ends + kBatches * 2 * kBatch);
  const Offset vertex = Offset{kPaddedStride} * (ends[kBatch] + kVertices);
  fetch_stream<sizeof(double) * kPaddedStride>(positions + vertex);
  fetch_stream<sizeof(double) * kPaddedStride>(forces + vertex);
}

/// Computes all batches, or the batches of a share.
template <class Lanes>
HWY_INLINE void add_forces(const Springs& springs, double stiffness, const double* positions, double* forces,
                           const OwnedBatches* share) {
  const Offset count =
      share ? static_cast<Offset>(share->batches.size()) : (springs.count + kBatch - 1) / kBatch;
  for (Offset i = 0; i < count; ++i) {
    const Offset batch = share ? share->batches[i] : i;
    const Index* const ends = springs.ends.data() + 2 * kBatch * batch;
    const double* const rest_length = springs.rest_lengths.data() + kBatch * batch;
    fetch_streams(rest_length, ends, positions, forces);
    add_batch<Lanes>(rest_length, ends, share ? share->targets_of(i, ends, 2) : ends, stiffness, positions,
                     forces);
  }
}

void add_forces_in_batches(const Springs& springs, double stiffness, const double* positions, double* forces,
                           const OwnedBatches* share) {
  add_forces<RowLanes>(springs, stiffness, positions, forces, share);
}

#if HWY_ONCE
void add_forces_one_by_one(const Springs& springs, double stiffness, const double* positions,
                           double* forces) {
  add_forces<OneLane>(springs, stiffness, positions, forces, nullptr);
}
#endif

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

#include <cmath>

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(add_forces_in_batches);

double distance(const double* a, const double* b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

}  // namespace

Springs springs_on_edges(const CsrGraph& graph, std::span<const Point> points) {
  Springs springs;
  springs.count = graph.edge_count();
  const Offset batches = (springs.count + kBatch - 1) / kBatch;
  springs.ends.assign(2 * batches * kBatch, 0);
  springs.rest_lengths.assign(batches * kBatch, 0.0);
  Offset s = 0;
  for (Index b = 0; b < graph.size(); ++b) {
    for (const Index a : graph[b]) {
      if (a > b) break;  // columns are ascending
      Index* const ends = springs.ends.data() + 2 * (s / kBatch) * kBatch + s % kBatch;
      ends[0] = a;
      ends[kBatch] = b;
      springs.rest_lengths[s++] = distance(points[a].data(), points[b].data());
    }
  }
  return springs;
}

double spring_energy(const Springs& springs, double stiffness, std::span<const double> positions) {
  double sum = 0.0;
  for (Offset s = 0; s < springs.count; ++s) {
    const Index* const ends = springs.ends.data() + 2 * (s / kBatch) * kBatch + s % kBatch;
    const double stretch = distance(positions.data() + Offset{kPaddedStride} * ends[0],
                                    positions.data() + Offset{kPaddedStride} * ends[kBatch]) -
                           springs.rest_lengths[s];
    sum += 0.5 * stiffness * stretch * stretch;
  }
  return sum;
}

void add_spring_forces(const Springs& springs, double stiffness, std::span<const double> positions,
                       std::span<double> forces) {
  check_same_size(positions, forces, "add_spring_forces");
  MESHORDER_SIMD(add_forces_in_batches)
  (springs, stiffness, positions.data(), forces.data(), nullptr);
}

void add_spring_forces(const Springs& springs, double stiffness, std::span<const double> positions,
                       std::span<double> forces, const OwnedBatches& share) {
  check_room(forces, share, "add_spring_forces");
  MESHORDER_SIMD(add_forces_in_batches)
  (springs, stiffness, positions.data(), forces.data(), &share);
}

void add_spring_forces_scalar(const Springs& springs, double stiffness, std::span<const double> positions,
                              std::span<double> forces) {
  check_same_size(positions, forces, "add_spring_forces");
  HWY_STATIC_DISPATCH(add_forces_one_by_one)(springs, stiffness, positions.data(), forces.data());
}

}  // namespace meshorder
#endif
