// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/hiding.hpp"

#include "base/parallel.hpp"
#include "base/run_scope.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

/// A part of a graph, with local numbers for its vertices.
class PartOfGraph {
 public:
  /// @param part_of   the part of each vertex of the graph
  /// @param vertices  the vertices of this part, ascending
  /// @param local     an entry for each vertex of the graph; receives the local numbers of `vertices`
  PartOfGraph(const Laplacian& laplacian, std::span<const Index> part_of, std::span<const double> masses,
              std::span<const Index> vertices, std::span<Index> local)
      : laplacian_(laplacian), of_(part_of), masses_(masses), vertices_(vertices), local_(local) {
    for (Index k = 0; k < size(); ++k) local[vertices[k]] = k;
  }

  [[nodiscard]] Index size() const { return index_size(vertices_); }
  [[nodiscard]] double mass(Index k) const { return masses_.empty() ? 1.0 : masses_[vertices_[k]]; }
  [[nodiscard]] Index local(Index v) const { return local_[v]; }

  /// Calls `visit(other, weight)` for the edges of vertex k that stay in the part.
  template <class Visit>
  void for_each_edge(Index k, Visit visit) const {
    const Index v = vertices_[k];
    for (Offset e = laplacian_.offsets[v]; e < laplacian_.offsets[v + 1]; ++e) {
      const Index u = laplacian_.neighbours[e];
      if (u < laplacian_.size() && of_[u] == of_[v]) visit(local_[u], laplacian_.weight(e));
    }
  }

 private:
  const Laplacian& laplacian_;
  std::span<const Index> of_;
  std::span<const double> masses_;
  std::span<const Index> vertices_;
  std::span<Index> local_;
};

/// Returns an aggregate's slack, computed as if each joining vertex spread its mass over all its edges to
/// founding members.
///
/// @param least  least weight of an edge between the founder and a founding member
double spread_slack(const PartOfGraph& part, Index founder, double least) {
  std::vector<double> founding_weight(static_cast<std::size_t>(part.size()));
  std::vector<double> hanging(founding_weight.size());
  part.for_each_edge(founder, [&](Index member, double weight) {
    if (weight >= least) founding_weight[member] = weight;
  });
  double slack = 0;
  for (Index k = 0; k < part.size(); ++k) {
    if (k == founder || founding_weight[k] > 0) continue;
    double sum = 0;
    part.for_each_edge(k, [&](Index member, double weight) {
      if (founding_weight[member] > 0 && weight > 0) sum += weight;
    });
    const double share = part.mass(k) / sum;
    slack = std::max(slack, share);
    part.for_each_edge(k, [&](Index member, double weight) {
      if (weight > 0) hanging[member] += share * weight;
    });
  }
  for (Index k = 0; k < part.size(); ++k) {
    if (founding_weight[k] > 0) slack = std::max(slack, (part.mass(k) + hanging[k]) / founding_weight[k]);
  }
  return slack;
}

/// Returns whether more than one pivot of a symmetric matrix is negative, or the sign of a pivot is
/// uncertain.
///
/// @param rows  the matrix's lower triangle, `size` entries a row; overwritten
bool has_two_negative_pivots(std::vector<double>& rows, Index size) {
  constexpr double kTooSmall = 1e-12;  // a pivot below this share of the diagonal may have the wrong sign
  const auto row = [&](Index v) { return rows.data() + std::ptrdiff_t{v} * size; };
  std::vector<double> diagonal(static_cast<std::size_t>(size));
  for (Index v = 0; v < size; ++v) diagonal[v] = std::abs(row(v)[v]);
  int negative = 0;
  for (Index k = 0; k < size; ++k) {
    poll_in_loop(k);
    const double pivot = row(k)[k];
    if (std::abs(pivot) <= kTooSmall * diagonal[k]) return true;
    if (pivot < 0 && ++negative > 1) return true;
    for (Index v = k + 1; v < size; ++v) {
      if (row(v)[k] == 0) continue;
      const double factor = row(v)[k] / pivot;
      for (Index u = k + 1; u <= v; ++u) row(v)[u] -= factor * row(u)[k];
    }
  }
  return false;
}

/// Returns whether L x = μ M x on the part has more than one eigenvalue below `bound`; true if uncertain.
bool has_two_below(const PartOfGraph& part, double bound) {
  const Index size = part.size();
  std::vector<double> rows(static_cast<std::size_t>(size) * size);
  for (Index k = 0; k < size; ++k) {
    double* const row = rows.data() + std::ptrdiff_t{k} * size;
    row[k] = -bound * part.mass(k);
    part.for_each_edge(k, [&](Index other, double weight) {
      row[k] += weight;
      if (other < k) row[other] -= weight;
    });
  }
  return has_two_negative_pivots(rows, size);
}

}  // namespace

bool may_hide(const Laplacian& laplacian, const Aggregation& aggregation, std::span<const double> masses,
              double eigenvalue) {
  constexpr Index kMostVertices = 300;  // computing the pivots of larger parts takes too long
  std::vector<Index> suspects;
  for (Index aggregate = 0; aggregate < index_size(aggregation.slacks); ++aggregate) {
    if (eigenvalue * aggregation.slacks[aggregate] > kDoubtful) suspects.push_back(aggregate);
  }
  if (suspects.empty()) return false;
  const Members members = members_of(aggregation, laplacian.size());
  std::vector<Index> local(aggregation.aggregate_of.size());
  std::atomic<bool> found = false;
  for_each_chunk(index_size(suspects), 1, [&](Index k, Index, Index) {
    if (found) return;
    const PartOfGraph part(laplacian, aggregation.aggregate_of, masses, members.of(suspects[k]), local);
    const Index founder = aggregation.founders[suspects[k]];
    const double least = strong_weight(laplacian, founder, aggregation.strength);
    if (eigenvalue * spread_slack(part, part.local(founder), least) <= kDoubtful) return;
    if (part.size() > kMostVertices || has_two_below(part, eigenvalue / kDoubtful)) found = true;
  });
  return found;
}

bool has_two_below(const Laplacian& laplacian, std::span<const double> masses, double bound) {
  std::vector<Index> vertices(static_cast<std::size_t>(laplacian.size()));
  std::iota(vertices.begin(), vertices.end(), Index{0});
  std::vector<Index> local(vertices.size());
  const std::vector<Index> part_of(vertices.size());
  return has_two_below(PartOfGraph(laplacian, part_of, masses, vertices, local), bound);
}

}  // namespace meshorder
