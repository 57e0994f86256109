// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "kernels/block_csr.hpp"

#include "base/parallel.hpp"

namespace meshorder {

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

void round_to_single(const BlockCsr& matrix, BlockCsrOf<float>& result) {
  constexpr Index kRows = 4096;
  result.offsets = matrix.offsets;
  result.columns = matrix.columns;
  // the copy has no spare blocks at the end of its values
  result.values.resize(9 * matrix.columns.size());
  for_each_chunk(matrix.size(), kRows, [&](Index, Index begin, Index end) {
    const Offset last = 9 * matrix.offsets[end];
    for (Offset i = 9 * matrix.offsets[begin]; i < last; ++i) {
      result.values[i] = static_cast<float>(matrix.values[i]);
    }
  });
}

}  // namespace meshorder
