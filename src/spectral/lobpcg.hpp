// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/run_scope.hpp"
#include "spectral/hierarchy.hpp"

#include <array>

namespace meshorder {

struct LobpcgOptions {
  double tolerance = 0.1;    ///< on ‖L x − λ B x‖ / (λ ‖x‖) of the first column
  int max_iterations = 500;  ///< more are not made; the result says whether it converged
  TimeLimit limit = {};      ///< ends the iteration like max_iterations
};

struct LobpcgResult {
  double eigenvalue = 0;  ///< of the first column
  double residual = 0;    ///< ‖L x − λ B x‖ / ‖x‖ of the first column
  int iterations = 0;
  bool converged = false;
};

/// Improves the columns of `x` towards the eigenvectors of L x = λ B x with the smallest eigenvalues after
/// that of the constant vector, on one level of a hierarchy (B its masses, the identity on the finest).
///
/// Locally optimal block preconditioned conjugate gradients (Knyazev 2001): each iteration minimises the
/// Rayleigh quotient over the span of x, the hierarchy's cycle applied to the residuals, the previous
/// directions, and `companions`, all kept orthogonal to constants. Companions are rough guesses of the next
/// eigenvectors: a single column that is slow to part from a close λ₃ parts quickly when it may subtract what
/// resembles that eigenvector, for far less than a second column costs. Columns end in ascending order of
/// their eigenvalues, ‖x‖_B = 1. Columns of x that depend on others or are constant are replaced by the
/// search itself. O(graph) an iteration.
template <int M, int Companions>
LobpcgResult lobpcg(const Hierarchy& hierarchy, int level, const LobpcgOptions& options, VectorBlock<M>& x,
                    VectorBlock<Companions> companions);

/// The same without companions.
template <int M>
LobpcgResult lobpcg(const Hierarchy& hierarchy, int level, const LobpcgOptions& options, VectorBlock<M>& x) {
  return lobpcg<M, 0>(hierarchy, level, options, x, {});
}

}  // namespace meshorder
