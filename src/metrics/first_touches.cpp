// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/first_touches.hpp"

#include "base/run_scope.hpp"
#include "graph/row_access.hpp"

#include <algorithm>
#include <vector>

namespace meshorder {
namespace {

constexpr Index kEntriesInLine = 8;  // doubles
constexpr Index kLinesBefore = 3;
constexpr Index kRecent = 32;  // first touches
constexpr Index kUntouched = -1;

}  // namespace

double jump_share(GraphRef graph, const Permutation& order) {
  if (graph.size() == 0) return 0;
  const Index lines = (graph.size() - 1) / kEntriesInLine + 1;
  std::vector<Index> touched(static_cast<std::size_t>(lines), kUntouched);  // the how many-th
  Index touches = 0;
  const auto is_jump = [&](Index line) {
    for (Index before = std::max(0, line - kLinesBefore); before < line; ++before) {
      if (touched[before] != kUntouched && touched[before] >= touches - kRecent) return false;
    }
    return true;
  };
  Index jumps = 0;
  std::vector<Index> found;
  for (Index row = 0; row < graph.size(); ++row) {
    poll_in_loop(row);
    prefetch_row(graph, order.new_to_old(), row);
    found.assign(1, row / kEntriesInLine);
    for (const Index u : graph[order.new_to_old()[row]]) {
      const Index line = order.old_to_new()[u] / kEntriesInLine;
      if (touched[line] == kUntouched) found.push_back(line);
    }
    std::sort(found.begin(), found.end());
    for (const Index line : found) {
      if (touched[line] != kUntouched) continue;
      jumps += is_jump(line) ? 1 : 0;
      touched[line] = touches++;
    }
  }
  return static_cast<double>(jumps) / lines;
}

}  // namespace meshorder
