// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "graph/laplacian.hpp"

namespace meshorder {

Laplacian combinatorial_laplacian(GraphRef graph) {
  Laplacian laplacian{graph.offsets, graph.neighbours, {}, std::vector<double>(graph.size())};
  for (Index v = 0; v < graph.size(); ++v) laplacian.diagonal[v] = graph.degree(v);
  return laplacian;
}

}  // namespace meshorder
