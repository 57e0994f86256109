// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/aggregation.hpp"

#include <algorithm>
#include <numeric>

namespace meshorder {
namespace {

constexpr Index kFree = -1;

struct Counts {
  Index alone = 0;
  std::vector<Index> founders;  ///< one for each aggregate
  std::vector<double> slacks;   ///< one for each aggregate
};

/// A vertex that joins an aggregate through an edge to its founder or to a founding member.
struct Joining {
  Index vertex;
  Index through;
  Index aggregate;
  double weight;
};

/// Returns the slack (see `aggregate`) of each aggregate of the rows from `begin` on.
///
/// @param founding_weight  for each row, the weight of its edge to the founder; 0 if there is none
std::vector<double> slacks_of(const std::vector<Joining>& joinings, std::span<const double> founding_weight,
                              std::span<const double> masses, Index begin,
                              const std::vector<Index>& aggregate_of, Index count) {
  const auto mass = [&](Index v) { return masses.empty() ? 1.0 : masses[v]; };
  std::vector<double> hanging(founding_weight.size());
  std::vector<double> slacks(static_cast<std::size_t>(count));
  for (const Joining& joining : joinings) {
    slacks[joining.aggregate] = std::max(slacks[joining.aggregate], mass(joining.vertex) / joining.weight);
    hanging[joining.through - begin] += mass(joining.vertex);
  }
  for (std::size_t k = 0; k < hanging.size(); ++k) {
    if (founding_weight[k] == 0) continue;
    const Index v = begin + static_cast<Index>(k);
    double& slack = slacks[aggregate_of[v]];
    slack = std::max(slack, (mass(v) + hanging[k]) / founding_weight[k]);
  }
  return slacks;
}

/// Aggregates the rows begin … end−1; the aggregates are numbered from 0.
Counts aggregate_rows(const Laplacian& laplacian, std::span<const double> masses, Index begin, Index end,
                      double strength, std::vector<Index>& of) {
  Counts counts;
  std::vector<double> founding_weight(static_cast<std::size_t>(end - begin));
  std::vector<Index>& founders = counts.founders;
  const auto inside = [&](Index u) { return u >= begin && u < end; };

  // a vertex founds an aggregate if it has strong neighbours and all of them are free
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
      of[u] = index_size(founders);
      founding_weight[u - begin] = laplacian.weight(k);
    }
    of[v] = index_size(founders);
    founders.push_back(v);
  }

  // each other vertex joins the aggregate of its strongest neighbour
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
  for (const Index v : alone) {
    of[v] = index_size(founders);
    founders.push_back(v);
  }
  counts.alone = index_size(alone);
  counts.slacks = slacks_of(joinings, founding_weight, masses, begin, of, index_size(founders));
  return counts;
}

}  // namespace

double strong_weight(const Laplacian& laplacian, Index v, double strength) {
  if (!laplacian.is_weighted()) return 1.0;
  double largest = 0;
  for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
    largest = std::max(largest, laplacian.weights[k]);
  }
  return std::max(strength * largest, 1e-300);
}

Members members_of(const Aggregation& aggregation, Index rows) {
  Members result;
  result.starts.assign(Offset{aggregation.count()} + 1, 0);
  for (Index v = 0; v < rows; ++v) ++result.starts[aggregation.aggregate_of[v] + 1];
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  std::vector<Index> next(result.starts.begin(), result.starts.end() - 1);
  result.members.resize(rows);
  for (Index v = 0; v < rows; ++v) {
    result.members[next[aggregation.aggregate_of[v]]++] = v;
  }
  return result;
}

Aggregation aggregate(const Laplacian& laplacian, const RowChunks& chunks, double strength,
                      std::span<const double> masses) {
  Aggregation result;
  result.strength = strength;
  std::vector<Index>& of = result.aggregate_of;
  of.assign(laplacian.size(), kFree);
  result.first_of_chunk.assign(Offset{chunks.count()} + 1, 0);
  std::vector<Counts> counts(chunks.count());
  chunks.for_each([&](Index chunk, Index begin, Index end) {
    counts[chunk] = aggregate_rows(laplacian, masses, begin, end, strength, of);
  });
  for (Index chunk = 0; chunk < chunks.count(); ++chunk) {
    result.first_of_chunk[chunk + 1] = index_size(counts[chunk].founders);
    result.founders.insert(result.founders.end(), counts[chunk].founders.begin(),
                           counts[chunk].founders.end());
    result.alone += counts[chunk].alone;
    result.slacks.insert(result.slacks.end(), counts[chunk].slacks.begin(), counts[chunk].slacks.end());
  }
  std::partial_sum(result.first_of_chunk.begin(), result.first_of_chunk.end(), result.first_of_chunk.begin());
  chunks.for_each([&](Index chunk, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) of[v] += result.first_of_chunk[chunk];
  });
  return result;
}

}  // namespace meshorder
