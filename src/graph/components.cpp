// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/components.hpp"

#include <algorithm>

namespace meshorder {

std::vector<std::vector<Index>> connected_components(const CsrGraph& graph) {
  std::vector<std::vector<Index>> components;
  std::vector<bool> reached(graph.size(), false);
  for (Index start = 0; start < graph.size(); ++start) {
    if (reached[start]) continue;
    std::vector<Index> component{start};
    reached[start] = true;
    for (std::size_t k = 0; k < component.size(); ++k) {
      for (const Index u : graph[component[k]]) {
        if (reached[u]) continue;
        reached[u] = true;
        component.push_back(u);
      }
    }
    std::sort(component.begin(), component.end());
    components.push_back(std::move(component));
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

}  // namespace meshorder
