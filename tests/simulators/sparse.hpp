// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "lab/linear/cholesky/ldl.hpp"

#include <Eigen/Dense>

#include <map>
#include <vector>

namespace meshorder::test {

/// The matrix with −weight for each edge, and on the diagonal the sum of a vertex's weights plus `shift`.
inline SparseMatrix shifted_laplacian(const CsrGraph& graph, double shift, bool weighted = true) {
  const auto weight = [&](Index u, Index v) { return weighted ? 1.0 + (u + v) % 5 + u * v % 3 : 1.0; };
  SparseMatrix matrix;
  for (Index v = 0; v < graph.size(); ++v) {
    std::map<Index, double> row{{v, shift}};
    for (const Index u : graph[v]) {
      row[u] = -weight(u, v);
      row[v] += weight(u, v);
    }
    for (const auto& [column, value] : row) {
      matrix.columns.push_back(column);
      matrix.values.push_back(value);
    }
    matrix.offsets.push_back(static_cast<Offset>(matrix.columns.size()));
  }
  return matrix;
}

inline SparseMatrix diagonal(const std::vector<double>& values) {
  SparseMatrix matrix;
  matrix.values = values;
  for (Index i = 0; i < index_size(values); ++i) {
    matrix.columns.push_back(i);
    matrix.offsets.push_back(i + 1);
  }
  return matrix;
}

inline Eigen::MatrixXd dense(const SparseMatrix& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(matrix.size(), matrix.size());
  for (Index i = 0; i < matrix.size(); ++i) {
    for (Offset k = matrix.offsets[i]; k < matrix.offsets[i + 1]; ++k) {
      result(i, matrix.columns[k]) = matrix.values[k];
    }
  }
  return result;
}

}  // namespace meshorder::test
