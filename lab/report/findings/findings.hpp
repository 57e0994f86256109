// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace meshorder {

/// Returns what the results show beyond the table of savings, in sentences to print below that table: limits
/// of the study, when orders pay off, whether all orders did the same work, and what spans, simulated caches
/// and predictions show. All follow from the numbers in `results`.
std::vector<std::string> findings_of(const StudyResults& results);

/// Returns findings on the meshes, as sentences: edge spans, simulated misses of the last cache level on each
/// processor and, in a study with scenarios, how far the predicted speedups of the kernels are off.
std::vector<std::string> mesh_findings(const StudyResults& results);

/// Errors of the predicted speedups of a kernel over the study's reference, for all meshes and orders with
/// predicted and measured times. An error is |predicted / measured − 1|.
struct PredictionError {
  int speedups = 0;           ///< number of errors; 0: the other numbers mean nothing
  double median = 0;          ///< the middle error, or the mean of the two middle errors
  double of_nine_tenths = 0;  ///< the smallest number that nine tenths of the errors do not exceed
  double largest = 0;
  int pairs = 0;                  ///< pairs of a mesh's orders whose measured times differ by more than 10 %
  int pairs_predicted_right = 0;  ///< pairs whose faster order was predicted
};

/// Returns the error of the predictions of `kKernels[kernel]`. O(orders² · meshes).
PredictionError prediction_error(const StudyResults& results, std::size_t kernel);

/// Returns predicted / measured − 1 of an order's speedup; negative: the order is better than predicted. Both
/// records must have both times, see has_both.
double signed_error(const KernelRecord& order, const KernelRecord& reference);

inline bool has_both(const KernelRecord& kernel) { return kernel.predicted_ms > 0 && kernel.measured_ms > 0; }

}  // namespace meshorder
