// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Ashcraft, Grimes: The Influence of Relaxed Supernode Partitions on the Multifrontal Method (1989).
#include "lab/linear/cholesky/supernodes.hpp"

#include <algorithm>

namespace meshorder {
namespace {

/// Returns the cost of a supernode of `columns` columns with `rows` rows below them.
double cost_of(Index columns, Offset rows, const PanelCosts& costs) {
  const Index panels = panel_count(columns, costs.widest);
  const double width = columns;
  // the rows of each panel include the columns of the later panels of its supernode
  const double rows_read = panels * static_cast<double>(rows) + (panels - 1) * width / 2;
  const double entries = width * static_cast<double>(rows) + width * (width - 1) / 2;
  return panels * costs.panel + rows_read * costs.row + entries;
}

Index add_task(SolveTasks& tasks, Index parent) {
  const Index task = tasks.count();
  tasks.parent.push_back(parent);
  tasks.children.emplace_back();
  if (parent >= 0) tasks.children[parent].push_back(task);
  return task;
}

/// Groups small branches into bundles that cost at least `min_cost`; the last bundle may cost less.
std::vector<std::vector<Index>> bundles_of(const std::vector<Index>& branches,
                                           const std::vector<double>& cost, double min_cost) {
  std::vector<std::vector<Index>> bundles;
  double sum = min_cost;
  for (const Index branch : branches) {
    if (sum >= min_cost) {
      bundles.emplace_back();
      sum = 0;
    }
    bundles.back().push_back(branch);
    sum += cost[branch];
  }
  return bundles;
}

}  // namespace

Supernodes find_supernodes(const Ldl& ldl, const PanelCosts& costs) {
  const Index n = ldl.size();
  const auto rows_below = [&](Index column) { return ldl.offsets[column + 1] - ldl.offsets[column]; };
  const auto parent_of = [&](Index column) {
    return rows_below(column) > 0 ? ldl.rows[ldl.offsets[column]] : Index{-1};
  };
  std::vector<Index> width(n, 1);
  std::vector<Index> joined_to(n, -1);  // a later column of the same supernode
  std::vector<double> cost(n);
  std::vector<std::vector<Index>> children(n);
  for (Index j = 0; j < n; ++j) {
    cost[j] = cost_of(1, rows_below(j), costs);
    // first the children that have the most rows in common with column j
    std::stable_sort(children[j].begin(), children[j].end(),
                     [&](Index a, Index b) { return rows_below(a) > rows_below(b); });
    for (const Index child : children[j]) {
      const double together = cost_of(width[child] + width[j], rows_below(j), costs);
      if (together > cost[child] + cost[j]) continue;
      joined_to[child] = j;
      width[j] += width[child];
      cost[j] = together;
    }
    if (parent_of(j) >= 0) children[parent_of(j)].push_back(j);
  }

  Supernodes supernodes;
  for (Index j = 0; j < n; ++j) {
    if (joined_to[j] < 0) {
      supernodes.top.push_back(j);
      supernodes.cost.push_back(cost[j]);
    }
  }
  supernodes.of_column.resize(n);
  for (Index s = 0; s < index_size(supernodes.top); ++s) supernodes.of_column[supernodes.top[s]] = s;
  for (Index j = n - 1; j >= 0; --j) {
    if (joined_to[j] >= 0) supernodes.of_column[j] = supernodes.of_column[joined_to[j]];
  }
  for (const Index top : supernodes.top) {
    supernodes.parent.push_back(parent_of(top) < 0 ? -1 : supernodes.of_column[parent_of(top)]);
  }
  return supernodes;
}

SolveTasks make_solve_tasks(const Supernodes& supernodes, double min_cost) {
  const Index n = supernodes.count();
  std::vector<double> cost = supernodes.cost;                 // of a supernode and all below it
  std::vector<std::vector<Index>> below(std::size_t(n) + 1);  // the last entry lists all roots
  for (Index s = 0; s < n; ++s) {
    const Index parent = supernodes.parent[s];
    if (parent >= 0) cost[parent] += cost[s];
    below[parent >= 0 ? parent : n].push_back(s);
  }

  SolveTasks tasks;
  std::vector<Index> task_of(std::size_t(n) + 1, add_task(tasks, -1));
  for (Index s = n; s >= 0; --s) {
    const Index task = task_of[s];
    std::vector<Index> light;
    std::vector<std::vector<Index>> branches;
    for (const Index child : below[s]) {
      if (cost[child] >= min_cost) {
        branches.push_back({child});
      } else {
        light.push_back(child);
      }
    }
    double rest = 0;
    for (const Index child : light) rest += cost[child];
    if (rest >= min_cost) {
      for (std::vector<Index>& bundle : bundles_of(light, cost, min_cost))
        branches.push_back(std::move(bundle));
      light.clear();
    }
    for (const Index child : light) task_of[child] = task;
    for (const std::vector<Index>& branch : branches) {
      const Index own = branches.size() > 1 ? add_task(tasks, task) : task;
      for (const Index child : branch) task_of[child] = own;
    }
  }

  tasks.supernodes.resize(tasks.count());
  tasks.cost.assign(tasks.count(), 0.0);
  for (Index s = 0; s < n; ++s) {
    tasks.supernodes[task_of[s]].push_back(s);
    tasks.cost[task_of[s]] += supernodes.cost[s];
  }
  for (Index task = tasks.count() - 1; task > 0; --task) tasks.cost[tasks.parent[task]] += tasks.cost[task];
  return tasks;
}

}  // namespace meshorder
