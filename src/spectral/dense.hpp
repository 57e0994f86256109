// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace meshorder {

/// The eigenvalues of a symmetric matrix, rising, and a unit eigenvector of each, column by column.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Returns the eigenpairs of a dense symmetric matrix, of which it reads the lower triangle. O(n³).
[[nodiscard]] Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

/// Returns the inverse of a dense symmetric positive definite matrix. O(n³).
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& positive_definite);

}  // namespace meshorder
