// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/laplacian.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

namespace meshorder::test {

/// The Laplacian in dense form; repeated off-diagonal entries are added up.
inline Eigen::MatrixXd dense(const Laplacian& laplacian) {
  const Index n = laplacian.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Index v = 0; v < n; ++v) {
    matrix(v, v) += laplacian.diagonal[v];
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      matrix(v, laplacian.neighbours[k]) -= laplacian.is_weighted() ? laplacian.weights[k] : 1.0;
    }
  }
  return matrix;
}

/// The combinatorial Laplacian D − A from the edges.
inline Eigen::MatrixXd dense_laplacian(const CsrGraph& graph) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(graph.size(), graph.size());
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) {
      matrix(v, u) -= 1;
      matrix(v, v) += 1;
    }
  }
  return matrix;
}

/// Eigenvalues in ascending order and their vectors.
inline Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense_eigen(const CsrGraph& graph) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense_laplacian(graph));
}

}  // namespace meshorder::test
