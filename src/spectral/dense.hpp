// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace meshorder {

/// The eigenvalues of a symmetric matrix, rising, and a unit eigenvector of each, column by column.
struct Eigenpairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// The eigenpairs of a dense symmetric matrix, of which the lower triangle is read. O(n³).
[[nodiscard]] Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

/// The inverse of a dense symmetric positive definite matrix. O(n³).
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& positive_definite);

}  // namespace meshorder
