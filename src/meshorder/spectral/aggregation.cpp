// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/spectral/aggregation.hpp>

#include <algorithm>

namespace meshorder {
namespace {

constexpr Index kFree = -1;

double weight(const Laplacian& laplacian, Offset k) {
  return laplacian.is_weighted() ? laplacian.weights[k] : 1.0;
}

/// The least weight of a strong neighbour of v.
double strong_weight(const Laplacian& laplacian, Index v, double strength) {
  if (!laplacian.is_weighted()) return 1.0;
  double largest = 0;
  for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
    largest = std::max(largest, laplacian.weights[k]);
  }
  return std::max(strength * largest, 1e-300);
}

}  // namespace

Aggregation aggregate(const Laplacian& laplacian, double strength) {
  const Index n = laplacian.size();
  Aggregation result;
  result.aggregate_of.assign(n, kFree);
  std::vector<Index>& of = result.aggregate_of;

  // found aggregates where the whole neighbourhood is free
  for (Index v = 0; v < n; ++v) {
    if (of[v] != kFree) continue;
    const double least = strong_weight(laplacian, v, strength);
    bool all_free = true;
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1] && all_free; ++k) {
      all_free = weight(laplacian, k) < least || of[laplacian.neighbours[k]] == kFree;
    }
    if (!all_free) continue;
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      if (weight(laplacian, k) >= least) of[laplacian.neighbours[k]] = result.count;
    }
    of[v] = result.count++;
  }

  // the rest joins the founded aggregate that pulls it most
  const std::vector<Index> founded = of;
  for (Index v = 0; v < n; ++v) {
    if (founded[v] != kFree) continue;
    double strongest = 0;
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      const Index u = laplacian.neighbours[k];
      if (founded[u] == kFree || weight(laplacian, k) <= strongest) continue;
      strongest = weight(laplacian, k);
      of[v] = founded[u];
    }
    if (of[v] == kFree) of[v] = result.count++;  // only where no neighbour has a positive weight
  }
  return result;
}

}  // namespace meshorder
