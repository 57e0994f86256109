// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Minimum discarded fill: D'Azevedo, Forsyth, Tang, Ordering Methods for Preconditioned Conjugate Gradient
// Methods Applied to Unstructured Grid Problems (1992). Here the entries keep their values, and the numbered
// vertices stay connected, so that the order sweeps through the mesh.
#include "base/run_scope.hpp"
#include "graph/level_search.hpp"
#include "graph/traversal.hpp"
#include "ordering/all_methods.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Returns for each entry a_ij of a graph its size |a_ij| / √(d_i · d_j), where d is the sum of a row.
/// Returns nothing for a graph without weights, whose entries all have the size 1.
std::vector<double> entry_sizes(const VertexInput& input, const BreadthFirstCopy& copy) {
  std::vector<double> sizes;
  if (input.weights.empty()) return sizes;
  const GraphRef graph = copy.graph();
  sizes.reserve(graph.neighbours.size());
  std::vector<double> row_sums(graph.size(), 0.0);
  for (Index v = 0; v < graph.size(); ++v) {
    const Offset row = input.graph.offsets[copy.old_numbers[v]];
    for (Index k = 0; k < graph.degree(v); ++k) {
      sizes.push_back(std::abs(input.weights[row + k]));
      row_sums[v] += sizes.back();
    }
  }
  for (Index v = 0; v < graph.size(); ++v) {
    for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
      const double sums = row_sums[v] * row_sums[graph.neighbours[k]];
      if (sums > 0) sizes[k] /= std::sqrt(sums);
    }
  }
  return sizes;
}

/// Numbers the vertices of components one after the other.
class Sweep {
 public:
  Sweep(GraphRef graph, std::span<const double> sizes)
      : graph_(graph),
        sizes_(sizes),
        place_(graph.size()),
        level_(graph.size(), kUntouched),
        rest_(graph.size(), 0.0),
        fill_(graph.size(), 0.0),
        size_to_(graph.size(), 0.0) {}

  /// Numbers the vertices of a component, from the first one; of vertices that discard about the same fill,
  /// takes the one that comes first. Fills `places` with them in their new order.
  void run(std::span<const Index> component, std::span<Index> places) {
    for (Index k = 0; k < index_size(component); ++k) place_[component[k]] = k;
    touch(component.front());
    for (std::size_t numbered = 0; numbered < places.size();) {
      const auto [level, place] = queue_.top();
      queue_.pop();
      const Index v = component[place];
      if (level_[v] != level) continue;  // it has been numbered, or discards less by now
      poll_in_loop(static_cast<Index>(numbered));
      places[numbered++] = v;
      number(v);
    }
    queue_ = {};
  }

 private:
  static constexpr int kNumbered = -2000;
  static constexpr int kUntouched = 2000;
  static constexpr int kNothing = -1900;

  [[nodiscard]] double size(Offset entry) const { return sizes_.empty() ? 1.0 : sizes_[entry]; }
  [[nodiscard]] bool is_left(Index v) const { return level_[v] != kNumbered; }

  void number(Index v) {
    level_[v] = kNumbered;
    for (const Index u : graph_[v]) size_to_[u] = is_left(u) ? 1.0 : 0.0;
    for (const Index u : graph_[v]) {
      if (is_left(u) && level_[u] != kUntouched) forget(v, u);
    }
    for (const Index u : graph_[v]) size_to_[u] = 0;
    for (const Index u : graph_[v]) {
      if (is_left(u)) touch(u);
    }
  }

  /// Takes the pairs of v from the fill of u. `size_to_` is 1 at the neighbours of v that are left.
  void forget(Index v, Index u) {
    double to_v = 0;
    double shared = 0;
    for (Offset k = graph_.offsets[u]; k < graph_.offsets[u + 1]; ++k) {
      const Index x = graph_.neighbours[k];
      if (x == v) to_v = size(k);
      shared += size(k) * size_to_[x];
    }
    fill_[u] -= to_v * (rest_[u] - to_v - shared);
    rest_[u] -= to_v;
  }

  /// Sets the fill of a vertex if it has none yet; puts the vertex into the queue if its level is new.
  void touch(Index v) {
    if (level_[v] == kUntouched) find_fill(v);
    constexpr double kLeast = 1e-7;  // of entries of size 1: less is a rounding error
    const int level = fill_[v] > kLeast ? std::ilogb(fill_[v]) : kNothing;
    if (level == level_[v]) return;
    level_[v] = level;
    queue_.emplace(level, place_[v]);
  }

  void find_fill(Index v) {
    const Offset begin = graph_.offsets[v];
    const Offset end = graph_.offsets[v + 1];
    double sum = 0;
    for (Offset k = begin; k < end; ++k) {
      const Index u = graph_.neighbours[k];
      size_to_[u] = is_left(u) ? size(k) : 0.0;
      sum += size_to_[u];
    }
    double twice = 0;
    for (Offset k = begin; k < end; ++k) {
      const Index u = graph_.neighbours[k];
      if (!is_left(u)) continue;
      double shared = 0;
      for (const Index x : graph_[u]) shared += size_to_[x];
      twice += size(k) * (sum - size(k) - shared);
    }
    for (const Index u : graph_[v]) size_to_[u] = 0;
    rest_[v] = sum;
    fill_[v] = twice / 2;
  }

  using Entry = std::pair<int, Index>;  // level, place in the component

  GraphRef graph_;
  std::span<const double> sizes_;
  std::vector<Index> place_;
  std::vector<int> level_;       ///< the logarithm of the fill
  std::vector<double> rest_;     ///< the sum of the entries to neighbours that are left
  std::vector<double> fill_;     ///< the sum of the products of entries to two of them that are no neighbours
  std::vector<double> size_to_;  ///< the entries of the vertex in work, else 0
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

Order mdf_vertices(const VertexInput& input, const OrderOptions&) {
  const BreadthFirstCopy copy = breadth_first_copy(input.graph);
  const std::vector<double> sizes = entry_sizes(input, copy);
  LevelSearch search(copy.graph());
  Sweep sweep(copy.graph(), sizes);
  std::vector<Index> new_to_old(std::size_t(input.graph.size()));
  std::size_t placed = 0;
  for (const BreadthFirstCopy::Component& component : copy.components) {
    const std::vector<Index> found = search_from_rim(copy, component, search);
    sweep.run(found, std::span(new_to_old).subspan(placed, found.size()));
    placed += found.size();
  }
  for (Index& v : new_to_old) v = copy.old_numbers[v];
  return {Permutation::from_new_to_old(std::move(new_to_old)), {}};
}

}  // namespace meshorder
