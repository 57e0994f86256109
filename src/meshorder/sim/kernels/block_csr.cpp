// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/sim/kernels/block_csr.hpp>

namespace meshorder {

Offset BlockCsr::find(Index row, Index column) const {
  const auto begin = columns.begin() + offsets[row];
  const auto end = columns.begin() + offsets[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  return found != end && *found == column ? found - columns.begin() : -1;
}

BlockCsr zero_block_csr(const CsrGraph& graph) {
  BlockCsr matrix;
  matrix.offsets.reserve(graph.offsets.size());
  matrix.columns.reserve(graph.neighbours.size() + graph.offsets.size() - 1);
  for (Index v = 0; v < graph.size(); ++v) {
    const auto row = graph[v];
    const auto after_diagonal = std::lower_bound(row.begin(), row.end(), v);
    matrix.columns.insert(matrix.columns.end(), row.begin(), after_diagonal);
    matrix.columns.push_back(v);
    matrix.columns.insert(matrix.columns.end(), after_diagonal, row.end());
    matrix.offsets.push_back(static_cast<Offset>(matrix.columns.size()));
  }
  matrix.values.assign(9 * matrix.columns.size(), 0.0);
  return matrix;
}

}  // namespace meshorder
