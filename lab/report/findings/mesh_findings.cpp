// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/median.hpp"
#include "lab/report/findings/findings.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Pairs of orders whose measured times differ by no more than this factor are not counted.
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
      const bool right = a_slower ? a.predicted_ms > b.predicted_ms : b.predicted_ms > a.predicted_ms;
      error.pairs_predicted_right += right ? 1 : 0;
    }
  }
}

/// Returns a sentence on each mesh's mean spans: the smallest, and the reference's.
std::string spans_in_words(const StudyResults& results) {
  std::vector<std::string> parts;
  for (const MeshRecord& mesh : results.meshes) {
    const MeshOrderRecord* const reference = find_order(mesh, results.reference);
    if (reference == nullptr) continue;
    const auto best = std::min_element(
        mesh.orders.begin(), mesh.orders.end(),
        [](const MeshOrderRecord& a, const MeshOrderRecord& b) { return a.span.mean < b.span.mean; });
    if (best->span.mean >= reference->span.mean) continue;
    parts.push_back(fmt::format("from {} to {} on {} ({})", with_digits(reference->span.mean, 3),
                                with_digits(best->span.mean, 3), mesh.name,
                                title_of(results, best->ordering)));
  }
  if (parts.empty()) return {};
  return fmt::format("From “{}” to the best order, the mean edge span falls {}.",
                     title_of(results, results.reference), in_words(parts));
}

/// Returns the misses of the last level of a hierarchy in an order: the sum over all kernels and meshes.
/// Empty if one of the kernels was not simulated.
std::optional<double> last_level_misses(const StudyResults& results, const std::string& ordering,
                                        std::size_t hierarchy) {
  double sum = 0;
  for (const MeshRecord& mesh : results.meshes) {
    const MeshOrderRecord* const order = find_order(mesh, ordering);
    if (order == nullptr) return std::nullopt;
    for (const KernelRecord& kernel : order->kernels) {
      if (kernel.accesses == 0 && kernel.misses.empty() && &kernel != &order->kernels.front()) continue;
      if (hierarchy >= kernel.misses.size() || kernel.misses[hierarchy].empty()) return std::nullopt;
      sum += static_cast<double>(kernel.misses[hierarchy].back());
    }
  }
  return sum;
}

/// Returns the misses on one processor: "7.13 M times on this machine (32 MB), 0.98 times as often in
/// Fiedler".
std::string misses_on(const StudyResults& results, std::size_t hierarchy) {
  const auto whole = last_level_misses(results, results.reference, hierarchy);
  const NamedCaches& caches = results.meshes.front().hierarchies[hierarchy];
  if (!whole || *whole <= 0 || caches.caches.level_bytes.empty()) return {};
  std::string words = fmt::format("{} times on {} ({})", metric(*whole), caches.name,
                                  bytes_in_words(static_cast<double>(caches.caches.level_bytes.back())));
  std::vector<std::string> others;
  for (const OrderingSpec& ordering : results.orderings) {
    const auto misses = last_level_misses(results, ordering.name, hierarchy);
    if (!misses || ordering.name == results.reference) continue;
    others.push_back(
        fmt::format("{:.2f} times as often in {}", *misses / *whole, title_of(results, ordering.name)));
  }
  return others.empty() ? words : fmt::format("{}, {}", words, in_words(others));
}

std::string misses_in_words(const StudyResults& results) {
  std::vector<std::string> parts;
  for (std::size_t h = 0; !results.meshes.empty() && h < results.meshes.front().hierarchies.size(); ++h) {
    std::string words = misses_on(results, h);
    if (!words.empty()) parts.push_back(std::move(words));
  }
  if (parts.empty()) return {};
  return fmt::format(
      "In simulation, one run of each kernel on each mesh in “{}” misses the last-level cache {}.",
      title_of(results, results.reference), fmt::join(parts, "; "));
}

/// Returns a sentence on the errors of the predicted speedups of all kernels.
std::string predictions_in_words(const StudyResults& results) {
  std::vector<std::string> parts;
  int pairs = 0;
  int predicted_right = 0;
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const PredictionError error = prediction_error(results, k);
    pairs += error.pairs;
    predicted_right += error.pairs_predicted_right;
    if (error.speedups > 0)
      parts.push_back(fmt::format("{:.0f} % for {}", 100 * error.median, kKernelTitles[k]));
  }
  if (parts.empty()) return {};
  std::string words =
      fmt::format("Predicted speedups of the kernels are off by {} in the median", in_words(parts));
  if (pairs > 0) {
    words += fmt::format(
        "; of {} pairs of orders that are more than 10 % apart, {} are predicted the right way "
        "round",
        pairs, predicted_right == pairs ? "all" : std::to_string(predicted_right));
  }
  return words + ".";
}

}  // namespace

std::vector<std::string> mesh_findings(const StudyResults& results) {
  std::vector<std::string> findings;
  findings.push_back(spans_in_words(results));
  findings.push_back(misses_in_words(results));
  // a study without scenarios shows the predictions in the page's section on prediction
  if (!results.scenarios.empty()) findings.push_back(predictions_in_words(results));
  std::erase(findings, "");
  return findings;
}

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
