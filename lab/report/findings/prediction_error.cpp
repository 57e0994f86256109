// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/prediction_error.hpp"

#include "base/median.hpp"
#include "lab/report/findings/lookup.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace meshorder {
namespace {

/// Pairs of orders whose measured times differ by a smaller factor are not counted.
constexpr double kApart = 1.1;

void count_pairs(const MeshRecord& mesh, std::size_t kernel, PredictionError& error) {
  for (std::size_t i = 0; i < mesh.orders.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const KernelRecord& a = mesh.orders[i].kernels[kernel];
      const KernelRecord& b = mesh.orders[j].kernels[kernel];
      if (!has_both(a) || !has_both(b)) continue;
      const bool a_slower = a.measured_ms > b.measured_ms;
      const double apart = a_slower ? a.measured_ms / b.measured_ms : b.measured_ms / a.measured_ms;
      if (apart <= kApart) continue;
      ++error.pairs;
      const bool told = a_slower ? a.predicted_ms > b.predicted_ms : b.predicted_ms > a.predicted_ms;
      error.pairs_told_right += told ? 1 : 0;
    }
  }
}

}  // namespace

double signed_error(const KernelRecord& order, const KernelRecord& reference) {
  const double predicted = reference.predicted_ms / order.predicted_ms;
  const double measured = reference.measured_ms / order.measured_ms;
  return predicted / measured - 1;
}

PredictionError prediction_error(const StudyResults& results, std::size_t kernel) {
  PredictionError error;
  std::vector<double> errors;
  for (const MeshRecord& mesh : results.meshes) {
    count_pairs(mesh, kernel, error);
    const MeshOrderRecord* const reference = find_order(mesh, results.reference);
    if (reference == nullptr || !has_both(reference->kernels[kernel])) continue;
    for (const MeshOrderRecord& order : mesh.orders) {
      if (&order == reference || !has_both(order.kernels[kernel])) continue;
      errors.push_back(std::abs(signed_error(order.kernels[kernel], reference->kernels[kernel])));
    }
  }
  if (errors.empty()) return error;
  std::sort(errors.begin(), errors.end());
  const std::size_t count = errors.size();
  error.speedups = static_cast<int>(count);
  error.median = median(errors);
  error.of_nine_tenths = errors[(9 * count + 9) / 10 - 1];
  error.largest = errors.back();
  return error;
}

}  // namespace meshorder
