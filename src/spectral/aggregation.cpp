// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/aggregation.hpp"

#include <algorithm>
#include <numeric>
#include <span>

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
  double slack = 0;
};

/// A vertex that joins an aggregate through an edge to a founding member.
struct Joining {
  Index vertex;
  Index through;
  Index aggregate;
  double weight;
};

/// The largest mass that hangs on an edge by which a vertex came to its aggregate, divided by its weight.
///
/// @param founding_weight  of the edge to the founder, for the rows from `begin` on; 0: none
double slack_of(const std::vector<Joining>& joinings, std::span<const double> founding_weight,
                std::span<const double> masses, Index begin) {
  const auto mass = [&](Index v) { return masses.empty() ? 1.0 : masses[v]; };
  std::vector<double> hanging(founding_weight.size());
  double slack = 0;
  for (const Joining& joining : joinings) {
    slack = std::max(slack, mass(joining.vertex) / joining.weight);
    hanging[joining.through - begin] += mass(joining.vertex);
  }
  for (std::size_t k = 0; k < hanging.size(); ++k) {
    if (founding_weight[k] == 0) continue;
    slack = std::max(slack, (mass(begin + static_cast<Index>(k)) + hanging[k]) / founding_weight[k]);
  }
  return slack;
}

/// Aggregates the rows begin … end−1, numbers from 0.
Counts aggregate_rows(const Laplacian& laplacian, std::span<const double> masses, Index begin, Index end,
                      double strength, std::vector<Index>& of) {
  Counts counts;
  std::vector<double> founding_weight(static_cast<std::size_t>(end - begin));
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
      if (!inside(u) || laplacian.weight(k) < least) continue;
      of[u] = count;
      founding_weight[u - begin] = laplacian.weight(k);
    }
    of[v] = count++;
  }

  // the rest joins the founded aggregate that pulls it most
  std::vector<Index> alone;
  std::vector<Joining> joinings;
  for (Index v = begin; v < end; ++v) {
    poll_in_loop(v);
    if (of[v] != kFree) continue;
    const double least = strong_weight(laplacian, v, strength);
    double strongest = 0;
    Index through = kFree;
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      const Index u = laplacian.neighbours[k];
      if (!inside(u) || of[u] == kFree || laplacian.weight(k) < least || laplacian.weight(k) <= strongest)
        continue;
      strongest = laplacian.weight(k);
      through = u;
      if (!laplacian.is_weighted()) break;
    }
    if (through == kFree) {  // no strong neighbour is in the chunk
      alone.push_back(v);
    } else {
      joinings.push_back({v, through, of[through], strongest});
    }
  }
  for (const Joining& joining : joinings) of[joining.vertex] = joining.aggregate;
  for (const Index v : alone) of[v] = count++;
  counts.alone = index_size(alone);
  counts.slack = slack_of(joinings, founding_weight, masses, begin);
  return counts;
}

}  // namespace

Aggregation aggregate(const Laplacian& laplacian, const RowChunks& chunks, double strength,
                      std::span<const double> masses) {
  Aggregation result;
  std::vector<Index>& of = result.aggregate_of;
  of.assign(laplacian.size(), kFree);
  result.first_of_chunk.assign(Offset{chunks.count()} + 1, 0);
  std::vector<Counts> counts(chunks.count());
  chunks.for_each([&](Index chunk, Index begin, Index end) {
    counts[chunk] = aggregate_rows(laplacian, masses, begin, end, strength, of);
  });
  for (Index chunk = 0; chunk < chunks.count(); ++chunk) {
    result.first_of_chunk[chunk + 1] = counts[chunk].aggregates;
    result.alone += counts[chunk].alone;
    result.slack = std::max(result.slack, counts[chunk].slack);
  }
  std::partial_sum(result.first_of_chunk.begin(), result.first_of_chunk.end(), result.first_of_chunk.begin());
  chunks.for_each([&](Index chunk, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) of[v] += result.first_of_chunk[chunk];
  });
  return result;
}

}  // namespace meshorder
