// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/least_squares.hpp"

#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace meshorder {
namespace {

/// Returns the Euclidean lengths of the columns.
std::vector<double> lengths_of(const Rows& a) {
  std::vector<double> lengths(a.columns, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.columns; ++j) lengths[j] += a[i][j] * a[i][j];
  }
  for (double& length : lengths) length = std::sqrt(length);
  return lengths;
}

/// Returns aᵀa after the columns are divided by their lengths; rows and columns of zero columns are 0.
std::vector<double> scaled_gram(const Rows& a, const std::vector<double>& lengths) {
  const std::size_t n = a.columns;
  std::vector<double> gram(n * n, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) gram[j * n + k] += a[i][j] * a[i][k];
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < n; ++k) {
      const double scale = lengths[j] * lengths[k];
      gram[j * n + k] = scale > 0 ? gram[j * n + k] / scale : 0.0;
    }
  }
  return gram;
}

// a column counts as dependent on the others if the squared sine of its angle to their span is below this
constexpr double kDependent = 1e-11;

/// Solves the normal equations of the chosen unknowns by Cholesky's factorisation. Returns false if their
/// columns depend on each other.
bool solve_chosen(const std::vector<double>& gram, const std::vector<double>& right,
                  const std::vector<std::size_t>& chosen, std::vector<double>& x) {
  const std::size_t n = right.size();
  const std::size_t m = chosen.size();
  std::vector<double> factor(m * m, 0.0);
  x.assign(m, 0.0);
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = gram[chosen[i] * n + chosen[j]];
      for (std::size_t k = 0; k < j; ++k) sum -= factor[i * m + k] * factor[j * m + k];
      if (i == j && !(sum > kDependent)) return false;
      factor[i * m + j] = i == j ? std::sqrt(sum) : sum / factor[j * m + j];
    }
    double sum = right[chosen[i]];
    for (std::size_t k = 0; k < i; ++k) sum -= factor[i * m + k] * x[k];
    x[i] = sum / factor[i * m + i];
  }
  for (std::size_t i = m; i-- > 0;) {
    for (std::size_t k = i + 1; k < m; ++k) x[i] -= factor[k * m + i] * x[k];
    x[i] /= factor[i * m + i];
  }
  return true;
}

}  // namespace

std::vector<double> non_negative_least_squares(const Rows& a, std::span<const double> b) {
  if (b.size() != a.size()) {
    throw InvalidArgument("least squares: " + std::to_string(b.size()) + " values for " +
                          std::to_string(a.size()) + " rows");
  }
  const std::size_t n = a.columns;
  const std::vector<double> lengths = lengths_of(a);
  const std::vector<double> gram = scaled_gram(a, lengths);
  std::vector<double> right(n, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < n; ++j) right[j] += lengths[j] > 0 ? a[i][j] * b[i] / lengths[j] : 0.0;
  }
  double largest = 0;
  for (const double value : right) largest = std::max(largest, std::abs(value));

  std::vector<double> x(n, 0.0);
  std::vector<bool> refused(n, false);  // unknowns that cannot join the chosen ones; reset by each choice
  std::vector<std::size_t> chosen;
  for (std::size_t step = 0; step < 10 * n; ++step) {
    // choose the unknown whose growth reduces the error fastest
    std::size_t best = n;
    double steepest = 1e-12 * largest;
    for (std::size_t j = 0; j < n; ++j) {
      if (refused[j] || lengths[j] == 0 || std::find(chosen.begin(), chosen.end(), j) != chosen.end())
        continue;
      double slope = right[j];
      for (const std::size_t k : chosen) slope -= gram[j * n + k] * x[k];
      if (slope <= steepest) continue;
      steepest = slope;
      best = j;
    }
    if (best == n) break;
    chosen.push_back(best);
    std::vector<double> solution;
    if (!solve_chosen(gram, right, chosen, solution) || solution.back() <= 0) {
      chosen.pop_back();
      refused[best] = true;
      continue;
    }
    refused.assign(n, false);
    // go from x towards the solution until an unknown becomes 0, drop that unknown and solve again
    while (std::any_of(solution.begin(), solution.end(), [](double value) { return value <= 0; })) {
      double share = 1;
      std::size_t first = 0;
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const double from = x[chosen[i]];
        if (solution[i] > 0 || from / (from - solution[i]) >= share) continue;
        share = from / (from - solution[i]);
        first = i;
      }
      for (std::size_t i = 0; i < chosen.size(); ++i) x[chosen[i]] += share * (solution[i] - x[chosen[i]]);
      x[chosen[first]] = 0;
      chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(first));
      (void)solve_chosen(gram, right, chosen, solution);
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) x[chosen[i]] = solution[i];
  }
  for (std::size_t j = 0; j < n; ++j) x[j] = lengths[j] > 0 ? x[j] / lengths[j] : 0.0;
  return x;
}

double condition_number(const Rows& a) {
  const std::vector<double> lengths = lengths_of(a);
  const std::size_t n = a.columns;
  std::vector<double> m = scaled_gram(a, lengths);
  // Jacobi rotations diagonalise the Gram matrix
  for (int sweep = 0; sweep < 60; ++sweep) {
    double beside = 0;
    for (std::size_t p = 0; p < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        const double pq = m[p * n + q];
        beside += pq * pq;
        if (pq == 0) continue;
        const double theta = (m[q * n + q] - m[p * n + p]) / (2 * pq);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::hypot(t, 1.0);
        const double s = t * c;
        for (std::size_t k = 0; k < n; ++k) {
          const double kp = m[k * n + p];
          const double kq = m[k * n + q];
          m[k * n + p] = c * kp - s * kq;
          m[k * n + q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < n; ++k) {
          const double pk = m[p * n + k];
          const double qk = m[q * n + k];
          m[p * n + k] = c * pk - s * qk;
          m[q * n + k] = s * pk + c * qk;
        }
      }
    }
    if (beside < 1e-30) break;
  }
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t j = 0; j < n; ++j) {
    if (lengths[j] == 0) continue;
    smallest = std::min(smallest, m[j * n + j]);
    largest = std::max(largest, m[j * n + j]);
  }
  if (largest == 0) return 1;
  // a smaller eigenvalue is only rounding error
  if (!(smallest > 1e-14 * largest)) return std::numeric_limits<double>::infinity();
  return std::sqrt(largest / smallest);
}

}  // namespace meshorder
