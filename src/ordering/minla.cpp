// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Minimum linear arrangement, whose relaxation the Fiedler vector solves: Juvan, Mohar, Optimal Linear
// Labelings and Eigenvalues of Graphs (1992). Multilevel search: Safro, Ron, Brandt, Graph Minimum Linear
// Arrangement by Multilevel Weighted Edge Contractions (2006).
#include "base/run_scope.hpp"
#include "ordering/all_methods.hpp"
#include "ordering/arrangement_graph.hpp"

#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kCoarsest = 40;  // graphs up to this size are not coarsened
constexpr int kPasses = 2;
constexpr int kVisits = 2;

/// Returns the subgraph of the vertices at places first … first + count − 1, which are whole components,
/// numbered in that order.
ArrangementGraph local_graph(GraphRef graph, const Permutation& order, Index first, Index count) {
  ArrangementGraph local;
  local.offsets.reserve(Offset{count} + 1);
  local.volumes.assign(count, 1);
  for (Index k = first; k < first + count; ++k) {
    poll_in_loop(k);
    for (const Index u : graph[order.new_to_old()[k]]) {
      local.neighbours.push_back(order.old_to_new()[u] - first);
    }
    local.offsets.push_back(static_cast<Offset>(local.neighbours.size()));
  }
  return local;
}

std::vector<Index> identity(Index n) {
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  return order;
}

/// Returns the vertices group by group along `coarse_order`; within a group in the order of `order`.
std::vector<Index> expanded(const std::vector<Index>& coarse_order, const std::vector<Index>& group_of,
                            const std::vector<Index>& order) {
  std::vector<Index> next(coarse_order.size(), 0);  // first the sizes of groups, then their next free places
  for (const Index g : group_of) ++next[g];
  Index place = 0;
  for (const Index g : coarse_order) place += std::exchange(next[g], place);
  std::vector<Index> result(order.size());
  for (const Index v : order) result[next[group_of[v]]++] = v;
  return result;
}

/// Replaces the order. Finds a new order on the coarser graph, where large parts move at once, and improves
/// it by moving single vertices. An order that is better on the coarser graph may be worse on this graph, so
/// the search runs twice; the second time, the groups follow the first new order. Keeps the better of the two
/// new orders, even if its span is larger than that of the given order.
void search(const ArrangementGraph& graph, TimeLimit limit, std::vector<Index>& order) {
  Offset least = std::numeric_limits<Offset>::max();
  for (int visit = 0; visit < kVisits; ++visit) {
    poll();
    std::vector<Index> candidate = order;
    bool twice = false;
    if (graph.size() > kCoarsest) {
      const CoarseArrangement coarse = coarsen(graph, order);
      const bool shrinks = Offset{10} * coarse.graph.size() <= Offset{9} * graph.size();
      if (shrinks) {
        std::vector<Index> coarse_order = identity(coarse.graph.size());
        search(coarse.graph, limit, coarse_order);
        candidate = expanded(coarse_order, coarse.group_of, order);
      }
      // a second visit of a larger coarse graph would make the cost exceed O(edges · log n) in all
      twice = 2 * coarse.graph.neighbours.size() <= graph.neighbours.size();
    }
    const Offset span = improve_by_insertions(graph, candidate, kPasses);
    if (span < least) {
      least = span;
      order = std::move(candidate);
    }
    if (!twice || limit.is_over()) return;
  }
}

}  // namespace

Order minla_vertices(const VertexInput& input, const OrderOptions& options) {
  Order result = fiedler_vertices(input, options);
  const std::span<const Index> start = result.permutation.new_to_old();
  std::vector<Index> new_to_old(start.begin(), start.end());
  const TimeLimit limit;
  report("improve");
  Index first = 0;
  for (const FiedlerComponent& component : result.fiedler) {
    if (component.size > 2 && !limit.is_over()) {
      const ArrangementGraph graph = local_graph(input.graph, result.permutation, first, component.size);
      std::vector<Index> order = identity(component.size);
      const Offset before = total_span(graph, order);
      search(graph, limit, order);
      if (total_span(graph, order) < before) {
        for (Index k = 0; k < component.size; ++k) new_to_old[first + k] = start[first + order[k]];
      }
    }
    first += component.size;
  }
  result.permutation = Permutation::from_new_to_old(std::move(new_to_old));
  result.complete = result.complete && !limit.is_over();
  return result;
}

}  // namespace meshorder
