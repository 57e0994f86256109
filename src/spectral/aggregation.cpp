// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/aggregation.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kFree = -1;

/// The least weight of a strong neighbour of v.
double strong_weight(const Laplacian& laplacian, Index v, double strength) {
  if (!laplacian.is_weighted()) return 1.0;
  double largest = 0;
  for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
    largest = std::max(largest, laplacian.weights[k]);
  }
  return std::max(strength * largest, 1e-300);
}

struct Counts {
  Index aggregates = 0;
  Index alone = 0;
};

/// Aggregates the rows begin … end−1, numbers from 0.
Counts aggregate_rows(const Laplacian& laplacian, Index begin, Index end, double strength,
                      std::vector<Index>& of) {
  Counts counts;
  Index& count = counts.aggregates;
  const auto inside = [&](Index u) { return u >= begin && u < end; };

  // found aggregates where there is a neighbourhood and all of it is free
  for (Index v = begin; v < end; ++v) {
    poll_in_loop(v);
    if (of[v] != kFree) continue;
    const double least = strong_weight(laplacian, v, strength);
    bool all_free = true;
    bool any = false;
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1] && all_free; ++k) {
      const Index u = laplacian.neighbours[k];
      if (!inside(u) || laplacian.weight(k) < least) continue;
      any = true;
      all_free = of[u] == kFree;
    }
    if (!all_free || !any) continue;
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      const Index u = laplacian.neighbours[k];
      if (inside(u) && laplacian.weight(k) >= least) of[u] = count;
    }
    of[v] = count++;
  }

  // the rest joins the founded aggregate that pulls it most
  std::vector<std::pair<Index, Index>> joining;
  for (Index v = begin; v < end; ++v) {
    poll_in_loop(v);
    if (of[v] != kFree) continue;
    const double least = strong_weight(laplacian, v, strength);
    double strongest = 0;
    Index joined = kFree;
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      const Index u = laplacian.neighbours[k];
      if (!inside(u) || of[u] == kFree || laplacian.weight(k) < least || laplacian.weight(k) <= strongest)
        continue;
      strongest = laplacian.weight(k);
      joined = of[u];
      if (!laplacian.is_weighted()) break;
    }
    if (joined == kFree) {  // no strong neighbour is in the chunk
      joined = count++;
      ++counts.alone;
    }
    joining.emplace_back(v, joined);
  }
  for (const auto& [v, joined] : joining) of[v] = joined;
  return counts;
}

}  // namespace

Aggregation aggregate(const Laplacian& laplacian, const RowChunks& chunks, double strength) {
  Aggregation result;
  std::vector<Index>& of = result.aggregate_of;
  of.assign(laplacian.size(), kFree);
  result.first_of_chunk.assign(Offset{chunks.count()} + 1, 0);
  std::vector<Counts> counts(chunks.count());
  chunks.for_each([&](Index chunk, Index begin, Index end) {
    counts[chunk] = aggregate_rows(laplacian, begin, end, strength, of);
  });
  for (Index chunk = 0; chunk < chunks.count(); ++chunk) {
    result.first_of_chunk[chunk + 1] = counts[chunk].aggregates;
    result.alone += counts[chunk].alone;
  }
  std::partial_sum(result.first_of_chunk.begin(), result.first_of_chunk.end(), result.first_of_chunk.begin());
  chunks.for_each([&](Index chunk, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) of[v] += result.first_of_chunk[chunk];
  });
  return result;
}

}  // namespace meshorder
