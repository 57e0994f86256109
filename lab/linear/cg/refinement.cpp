// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/cg/refinement.hpp"

#include "kernels/spmv.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace meshorder {
namespace {

/// r = b − A x; its norm.
double compute_residual(const BlockCsr& matrix, std::span<const double> b, std::span<const double> x,
                        std::span<double> r) {
  multiply(matrix, x, r);
  double sum = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    r[i] = b[i] - r[i];
    sum += r[i] * r[i];
  }
  return std::sqrt(sum);
}

}  // namespace

SolveReport refined_conjugate_gradients(const BlockCsr& matrix, const BlockCsrOf<float>& rounded,
                                        const Preconditioner& preconditioner, std::span<const double> b,
                                        std::span<double> x, const SolveOptions& options) {
  constexpr int kCorrections = 10;
  constexpr double kMargin = 0.9;  // so that rounding seldom asks for another correction
  std::vector<double> residual(b.size());
  std::vector<double> correction(b.size());
  const double start = compute_residual(matrix, b, x, residual);
  double norm = start;
  SolveReport total;
  if (start == 0.0) return total;
  for (int i = 0; i < kCorrections; ++i) {
    SolveOptions inner = options;
    inner.tolerance = std::min(0.5, kMargin * options.tolerance * start / norm);
    inner.max_iterations = options.max_iterations - total.iterations;
    std::fill(correction.begin(), correction.end(), 0.0);
    SolveReport report = conjugate_gradients(rounded, preconditioner, residual, correction, inner);
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += correction[k];
    report.iterations += total.iterations;
    norm = compute_residual(matrix, b, x, residual);
    report.residual = norm / start;
    total = report;
    if (report.status != SolveStatus::converged || norm <= options.tolerance * start) return total;
  }
  total.status = SolveStatus::iteration_limit;
  return total;
}

}  // namespace meshorder
