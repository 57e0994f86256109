// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "ordering/arrangement_graph.hpp"

#include "base/run_scope.hpp"

#include <cstdlib>

namespace meshorder {
namespace {

constexpr Index kNone = -1;
constexpr Index kMaxGroup = 8;

/// Sets `group_of` of all vertices and returns the number of groups.
Index group(const ArrangementGraph& graph, const std::vector<Index>& order, std::vector<Index>& group_of) {
  const std::vector<Offset> middle = middles(graph, order);
  group_of.assign(graph.size(), kNone);
  std::vector<Index> members;  // number of members of each group
  for (const Index v : order) {
    poll_in_loop(v);
    if (group_of[v] != kNone) continue;
    double strongest = 0;
    Index partner = kNone;
    for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
      const Index u = graph.neighbours[k];
      if (group_of[u] != kNone && members[group_of[u]] == kMaxGroup) continue;
      const auto distance = static_cast<double>(std::abs(middle[u] - middle[v]));
      const double pull = static_cast<double>(graph.weight(k)) / distance;
      if (pull <= strongest) continue;
      strongest = pull;
      partner = u;
    }
    if (partner == kNone || group_of[partner] == kNone) {
      group_of[v] = index_size(members);
      members.push_back(1);
      if (partner == kNone) continue;
      group_of[partner] = group_of[v];
    } else {
      group_of[v] = group_of[partner];
    }
    ++members[group_of[v]];
  }
  return index_size(members);
}

}  // namespace

std::vector<Offset> middles(const ArrangementGraph& graph, const std::vector<Index>& order) {
  std::vector<Offset> middle(graph.size());
  Offset begin = 0;
  for (const Index v : order) {
    middle[v] = begin + graph.volumes[v];
    begin += 2 * Offset{graph.volumes[v]};
  }
  return middle;
}

Offset total_span(const ArrangementGraph& graph, const std::vector<Index>& order) {
  const std::vector<Offset> middle = middles(graph, order);
  Offset sum = 0;
  for (Index v = 0; v < graph.size(); ++v) {
    poll_in_loop(v);
    for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
      sum += graph.weight(k) * std::abs(middle[v] - middle[graph.neighbours[k]]);
    }
  }
  return sum / 2;  // every edge was counted at both ends
}

CoarseArrangement coarsen(const ArrangementGraph& graph, const std::vector<Index>& order) {
  CoarseArrangement result;
  std::vector<Index>& group_of = result.group_of;
  const Index count = group(graph, order, group_of);

  // list the members of each group
  std::vector<Index> first(Offset{count} + 1, 0);
  for (const Index g : group_of) ++first[g + 1];
  for (Index g = 0; g < count; ++g) first[g + 1] += first[g];
  std::vector<Index> members(graph.size());
  std::vector<Index> next(first.begin(), first.end() - 1);
  for (const Index v : order) members[next[group_of[v]]++] = v;

  // add up the rows of each group's members
  ArrangementGraph& coarse = result.graph;
  coarse.volumes.assign(count, 0);
  coarse.offsets.reserve(Offset{count} + 1);
  std::vector<Offset> entry_of(count, -1);  // the last entry of each group, in this or an earlier row
  for (Index g = 0; g < count; ++g) {
    poll_in_loop(g);
    const Offset row = coarse.offsets.back();
    for (Index m = first[g]; m < first[g + 1]; ++m) {
      const Index v = members[m];
      coarse.volumes[g] += graph.volumes[v];
      for (Offset k = graph.offsets[v]; k < graph.offsets[v + 1]; ++k) {
        const Index h = group_of[graph.neighbours[k]];
        if (h == g) continue;
        if (entry_of[h] < row) {
          entry_of[h] = static_cast<Offset>(coarse.neighbours.size());
          coarse.neighbours.push_back(h);
          coarse.weights.push_back(0);
        }
        coarse.weights[entry_of[h]] += graph.weight(k);
      }
    }
    coarse.offsets.push_back(static_cast<Offset>(coarse.neighbours.size()));
  }
  return result;
}

}  // namespace meshorder
