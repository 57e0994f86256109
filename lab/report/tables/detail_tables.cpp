// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/findings/findings.hpp"
#include "lab/report/findings/lookup.hpp"
#include "lab/report/findings/numbers_in_words.hpp"
#include "lab/report/tables/each_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace meshorder {
namespace {

/// Calls `row(mesh, kernel, order, reference)` for each kernel and order; a missing reference is null.
template <class Row>
void for_each_kernel(const StudyResults& results, Row row) {
  for (const MeshRecord& mesh : results.meshes) {
    const MeshOrderRecord* const reference = find_order(mesh, results.reference);
    for (std::size_t k = 0; k < kKernels.size(); ++k) {
      for (const OrderingSpec& ordering : results.orderings) {
        if (const MeshOrderRecord* const order = find_order(mesh, ordering.name))
          row(mesh, k, *order, reference);
      }
    }
  }
}

TableCell kernel_head(const StudyResults& results, const MeshRecord& mesh, std::size_t kernel,
                      const MeshOrderRecord& order) {
  return text_cell(
      fmt::format("{}, {}, {}", mesh.name, kKernelTitles[kernel], title_of(results, order.ordering)));
}

/// Returns the misses of a level, if the record has them.
std::optional<Offset> misses_of(const MeshOrderRecord& order, std::size_t kernel, std::size_t hierarchy,
                                std::size_t level) {
  const auto& misses = order.kernels[kernel].misses;
  if (hierarchy >= misses.size() || level >= misses[hierarchy].size()) return std::nullopt;
  return misses[hierarchy][level];
}

/// Returns "12.3 k (0.43×)": misses, and their ratio to the reference's.
TableCell misses_cell(const std::optional<Offset>& misses, const std::optional<Offset>& reference) {
  if (!misses) return unknown_cell();
  TableCell cell{metric(static_cast<double>(*misses)), static_cast<double>(*misses), false};
  if (reference && *reference > 0) {
    cell.text += fmt::format(" ({:.2f}×)", static_cast<double>(*misses) / static_cast<double>(*reference));
  }
  return cell;
}

TableCell factor_cell(double milliseconds, double reference) {
  if (milliseconds <= 0 || reference <= 0) return unknown_cell();
  const double factor = reference / milliseconds;
  return {fmt::format("{:.2f}×", factor), factor, false};
}

TableCell error_cell(const KernelRecord& kernel, const KernelRecord& reference, bool is_reference) {
  if (is_reference || !has_both(kernel) || !has_both(reference)) return unknown_cell();
  return percent_cell(100 * signed_error(kernel, reference));
}

/// Returns the index of a hierarchy in a mesh's list.
std::optional<std::size_t> place_of(const std::string& hierarchy, const MeshRecord& mesh) {
  for (std::size_t h = 0; h < mesh.hierarchies.size(); ++h) {
    if (mesh.hierarchies[h].name == hierarchy) return h;
  }
  return std::nullopt;
}

Table misses_table(const StudyResults& results, const NamedCaches& hierarchy, std::size_t number) {
  Table table{fmt::format("misses-{}", number),
              fmt::format("Simulated cache misses: {}", hierarchy.name),
              fmt::format("Cache lines that each run of a repeated kernel fetches from beyond a level, in a "
                          "model that keeps the "
                          "most recently used lines, does not prefetch and serves one thread; in brackets, "
                          "divided by those of "
                          "“{}”.",
                          title_of(results, results.reference)),
              {"Mesh, kernel and order"},
              {}};
  for (std::size_t level = 0; level < hierarchy.caches.level_bytes.size(); ++level) {
    table.columns.push_back(fmt::format(
        "L{} {}", level + 1, bytes_in_words(static_cast<double>(hierarchy.caches.level_bytes[level]))));
  }
  for_each_kernel(results, [&](const MeshRecord& mesh, std::size_t kernel, const MeshOrderRecord& order,
                               const MeshOrderRecord* reference) {
    const auto place = place_of(hierarchy.name, mesh);
    if (!place || !misses_of(order, kernel, *place, 0)) return;
    table.rows.push_back({kernel_head(results, mesh, kernel, order)});
    for (std::size_t level = 0; level < hierarchy.caches.level_bytes.size(); ++level) {
      const bool compared = reference != nullptr && reference != &order;
      table.rows.back().push_back(
          misses_cell(misses_of(order, kernel, *place, level),
                      compared ? misses_of(*reference, kernel, *place, level) : std::nullopt));
    }
  });
  return table;
}

}  // namespace

Table phases_table(const StudyResults& results) {
  Table table{
      "phases",
      "Seconds by phase of a step",
      "Means of the runs. By element: backward Euler's assembly, ADMM's local step. System: the linear "
      "solve, the global step. Iterations: of conjugate gradients, of ADMM; rounding differs between "
      "orders, so they may take a few more or less.",
      {"Scenario and order", "By element, s", "System, s", "Collision, s", "Other, s", "Iterations"},
      {}};
  const bool has_fluid =
      std::ranges::any_of(results.scenarios, [](const auto& one) { return one.method == "particle-fem"; });
  if (has_fluid) {
    table.columns.insert(table.columns.begin() + 1, {"Mesh, s", "Order, s"});
    table.caption += " A fluid makes and orders its mesh in each step.";
  }
  for_each_order(results, false, [&](const ScenarioRecord& scenario, const ScenarioOrderRecord& order) {
    const Phases phases = phases_of(order);
    const double iterations = mean_iterations(order);
    auto& row = table.rows.emplace_back();
    row.push_back(head_of(results, scenario, order));
    if (has_fluid) {
      row.push_back(number_cell(phases.mesh));
      row.push_back(number_cell(phases.order));
    }
    for (const double seconds : {phases.elements, phases.system, phases.collision, phases.other})
      row.push_back(number_cell(seconds));
    row.push_back({metric(iterations), iterations, false});
  });
  return table;
}

Table motions_table(const StudyResults& results) {
  Table table{
      "motions",
      "The same motion in every order",
      fmt::format("The largest distance, over all frames, between a vertex and the same vertex in the "
                  "order “{}”, divided by the body's longest side.",
                  results.orderings.empty() ? "" : title_of(results, results.orderings.front().name)),
      {"Scenario and order", "Largest difference"},
      {}};
  for_each_order(results, false, [&](const ScenarioRecord& scenario, const ScenarioOrderRecord& order) {
    if (order.motion.by_frame.empty()) return;
    const double largest = order.motion.largest;
    table.rows.push_back({head_of(results, scenario, order),
                          {largest == 0 ? "0" : fmt::format("{:.1e}", largest), largest, false}});
  });
  return table;
}

std::vector<Table> misses_tables(const StudyResults& results) {
  std::vector<Table> tables;
  std::vector<std::string> done;
  for (const MeshRecord& mesh : results.meshes) {
    for (const NamedCaches& hierarchy : mesh.hierarchies) {
      if (std::find(done.begin(), done.end(), hierarchy.name) != done.end()) continue;
      done.push_back(hierarchy.name);
      tables.push_back(misses_table(results, hierarchy, done.size()));
    }
  }
  return tables;
}

Table kernels_table(const StudyResults& results) {
  Table table{
      "kernels",
      "Kernels: predicted and measured",
      fmt::format("How many times faster than in the order “{}” a kernel runs: predicted from simulated "
                  "misses with the costs of the model's machine, and measured on one thread of this "
                  "machine, best of interleaved rounds. Error: predicted divided by measured, less 1; "
                  "negative where the order is better than predicted.",
                  title_of(results, results.reference)),
      {"Mesh, kernel and order", "Predicted", "Measured", "Error, %", "Measured, ms"},
      {}};
  for_each_kernel(results, [&](const MeshRecord& mesh, std::size_t k, const MeshOrderRecord& order,
                               const MeshOrderRecord* reference) {
    const KernelRecord& kernel = order.kernels[k];
    if (kernel.predicted_ms <= 0 && kernel.measured_ms <= 0) return;
    const KernelRecord compared = reference == nullptr ? KernelRecord{} : reference->kernels[k];
    table.rows.push_back({kernel_head(results, mesh, k, order),
                          factor_cell(kernel.predicted_ms, compared.predicted_ms),
                          factor_cell(kernel.measured_ms, compared.measured_ms),
                          error_cell(kernel, compared, &order == reference),
                          kernel.measured_ms > 0 ? number_cell(kernel.measured_ms, 3) : unknown_cell()});
  });
  return table;
}

Table prediction_table(const StudyResults& results) {
  Table table{
      "prediction-error",
      "How far the predictions are off",
      fmt::format("Error of a predicted speedup over “{}”: predicted divided by measured, less 1, without "
                  "its sign; over all meshes and orders. Right: pairs of orders of a mesh that are "
                  "measured more than 10 % apart and whose faster order is predicted to be the faster one.",
                  title_of(results, results.reference)),
      {"Kernel", "Speedups", "Median error, %", "90 % within, %", "Largest, %", "Right", "Of pairs"},
      {}};
  for (std::size_t k = 0; k < kKernels.size(); ++k) {
    const PredictionError error = prediction_error(results, k);
    if (error.speedups == 0) continue;
    table.rows.push_back({text_cell(std::string(kKernelTitles[k])), count_cell(error.speedups),
                          number_cell(100 * error.median, 2), number_cell(100 * error.of_nine_tenths, 2),
                          number_cell(100 * error.largest, 2), count_cell(error.pairs_predicted_right),
                          count_cell(error.pairs)});
  }
  return table;
}

}  // namespace meshorder
