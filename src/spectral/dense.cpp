// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace meshorder {

Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {.values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& positive_definite) {
  const Eigen::Index n = positive_definite.rows();
  return positive_definite.llt().solve(Eigen::MatrixXd::Identity(n, n));
}

}  // namespace meshorder
