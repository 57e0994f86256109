// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cholesky/supernodes.hpp"
#include "simulators/sparse.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace meshorder {
namespace {

Ldl factor_of(const CsrGraph& graph) { return factor_ldl(test::shifted_laplacian(graph, 0.1)); }

double total_cost(const Supernodes& supernodes) {
  return std::accumulate(supernodes.cost.begin(), supernodes.cost.end(), 0.0);
}

TEST(FindSupernodes, HoldTheRowsOfAllTheirColumns) {
  for (const CsrGraph& graph : {test::grid(20, 20), test::grid(8, 8, 8), test::star(30), test::path(50)}) {
    const Ldl ldl = factor_of(graph);
    const Supernodes supernodes = find_supernodes(ldl);
    for (Index j = 0; j < ldl.size(); ++j) {
      const Index s = supernodes.of_column[j];
      const Index top = supernodes.top[s];
      ASSERT_LE(j, top);
      for (Offset k = ldl.offsets[j]; k < ldl.offsets[j + 1]; ++k) {
        const auto begin = ldl.rows.begin() + ldl.offsets[top];
        const auto end = ldl.rows.begin() + ldl.offsets[top + 1];
        EXPECT_TRUE(supernodes.of_column[ldl.rows[k]] == s || std::binary_search(begin, end, ldl.rows[k]));
      }
    }
    for (Index s = 0; s < supernodes.count(); ++s) {
      const Index top = supernodes.top[s];
      const bool is_root = ldl.offsets[top] == ldl.offsets[top + 1];
      const Index parent = is_root ? -1 : supernodes.of_column[ldl.rows[ldl.offsets[top]]];
      EXPECT_EQ(supernodes.parent[s], parent);
      EXPECT_TRUE(is_root || parent > s);
    }
  }
}

TEST(FindSupernodes, JoinColumnsForWhatThatSaves) {
  const Ldl ldl = factor_of(test::grid(30, 30));
  const Supernodes without_costs = find_supernodes(ldl, {.widest = 8, .panel = 0, .row = 0});
  const double entries = static_cast<double>(ldl.offsets.back());
  EXPECT_EQ(total_cost(without_costs), entries);  // columns are joined only where no zero is stored
  EXPECT_LT(without_costs.count(), ldl.size());
  const PanelCosts costs;
  const Supernodes joined = find_supernodes(ldl, costs);
  EXPECT_LT(joined.count(), without_costs.count());
  EXPECT_LT(total_cost(joined), (1 + costs.row) * entries + costs.panel * ldl.size());
  // a dense matrix that fits into one panel
  EXPECT_EQ(find_supernodes(factor_of(test::complete(costs.widest))).count(), 1);
}

/// EXPECTs that every supernode is in one task, and its parent in the same task or in the parent task.
void expect_tree(const SolveTasks& tasks, const Supernodes& supernodes) {
  std::vector<Index> task_of(supernodes.count(), -1);
  for (Index task = 0; task < tasks.count(); ++task) {
    EXPECT_TRUE(std::is_sorted(tasks.supernodes[task].begin(), tasks.supernodes[task].end()));
    for (const Index s : tasks.supernodes[task]) {
      EXPECT_EQ(task_of[s], -1);
      task_of[s] = task;
    }
    EXPECT_LT(tasks.parent[task], task);
    EXPECT_EQ(tasks.parent[task] < 0, task == 0);
    for (const Index child : tasks.children[task]) EXPECT_EQ(tasks.parent[child], task);
    EXPECT_NE(tasks.children[task].size(), 1);
  }
  for (Index s = 0; s < supernodes.count(); ++s) {
    ASSERT_GE(task_of[s], 0);
    const Index parent = supernodes.parent[s] < 0 ? 0 : task_of[supernodes.parent[s]];
    EXPECT_TRUE(task_of[s] == parent || tasks.parent[task_of[s]] == parent);
  }
  EXPECT_NEAR(tasks.cost[0], total_cost(supernodes), 1e-9 * tasks.cost[0]);
}

TEST(SolveTasks, ShareAGridOutEvenly) {
  const Supernodes supernodes = find_supernodes(factor_of(test::grid(100, 100)));
  const double cost = total_cost(supernodes);
  const SolveTasks tasks = make_solve_tasks(supernodes, cost / 32);
  expect_tree(tasks, supernodes);
  EXPECT_GE(tasks.count(), 15);
  double largest = 0;
  for (Index task = 0; task < tasks.count(); ++task) {
    EXPECT_GE(tasks.cost[task], cost / 32 * 0.999);
    if (tasks.children[task].empty()) largest = std::max(largest, tasks.cost[task]);
  }
  EXPECT_LT(largest, cost / 8);
  EXPECT_EQ(make_solve_tasks(supernodes, 2 * cost).count(), 1);
}

TEST(SolveTasks, BundleWhatIsSmall) {
  const CsrGraph pieces = test::disjoint_union(std::vector<CsrGraph>(100, test::grid(5, 5)));
  const Supernodes supernodes = find_supernodes(factor_of(pieces));
  const SolveTasks tasks = make_solve_tasks(supernodes, total_cost(supernodes) / 10);
  expect_tree(tasks, supernodes);
  EXPECT_TRUE(tasks.supernodes[0].empty());
  EXPECT_GE(tasks.children[0].size(), 8);
  EXPECT_LE(tasks.children[0].size(), 11);
}

TEST(SolveTasks, OfNothingAreOne) {
  const SolveTasks tasks = make_solve_tasks({}, 1.0);
  EXPECT_EQ(tasks.count(), 1);
  EXPECT_TRUE(tasks.supernodes[0].empty());
}

}  // namespace
}  // namespace meshorder
