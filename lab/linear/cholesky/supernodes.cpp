// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Ashcraft, Grimes: The Influence of Relaxed Supernode Partitions on the Multifrontal Method (1989).
#include "lab/linear/cholesky/supernodes.hpp"

#include <algorithm>

namespace meshorder {
namespace {

/// Of a supernode with so many columns and rows below them.
double cost_of(Index columns, Offset rows, const PanelCosts& costs) {
  const Index panels = panel_count(columns, costs.widest);
  const double width = columns;
  // each panel has the columns of the later ones among its rows
  const double rows_read = panels * static_cast<double>(rows) + (panels - 1) * width / 2;
  const double entries = width * static_cast<double>(rows) + width * (width - 1) / 2;
  return panels * costs.panel + rows_read * costs.row + entries;
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
    // those first that lack the fewest rows
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

}  // namespace meshorder
