// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/solve_tasks.hpp"

namespace meshorder {
namespace {

Index add_task(SolveTasks& tasks, Index parent) {
  const Index task = tasks.count();
  tasks.parent.push_back(parent);
  tasks.children.emplace_back();
  if (parent >= 0) tasks.children[parent].push_back(task);
  return task;
}

/// Branches that are small by themselves, together worth a task; the last bundle may be worth less.
std::vector<std::vector<Index>> bundles_of(const std::vector<Index>& branches,
                                           const std::vector<double>& cost, double least) {
  std::vector<std::vector<Index>> bundles;
  double sum = least;
  for (const Index branch : branches) {
    if (sum >= least) {
      bundles.emplace_back();
      sum = 0;
    }
    bundles.back().push_back(branch);
    sum += cost[branch];
  }
  return bundles;
}

}  // namespace

SolveTasks make_solve_tasks(const Supernodes& supernodes, double least) {
  const Index n = supernodes.count();
  std::vector<double> cost = supernodes.cost;                 // of a supernode and all below it
  std::vector<std::vector<Index>> below(std::size_t(n) + 1);  // the last is that of all roots
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
      if (cost[child] >= least) {
        branches.push_back({child});
      } else {
        light.push_back(child);
      }
    }
    double rest = 0;
    for (const Index child : light) rest += cost[child];
    if (rest >= least) {
      for (std::vector<Index>& bundle : bundles_of(light, cost, least)) branches.push_back(std::move(bundle));
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
