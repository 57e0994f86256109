// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/study/results.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace meshorder {

/// Calls `row(scenario, order)` for all orders with finished runs. With `against_reference`, skips the
/// reference and scenarios in which it has not run.
template <class Row>
void for_each_order(const StudyResults& results, bool against_reference, Row row) {
  for (const ScenarioRecord& scenario : results.scenarios) {
    if (against_reference && find_order(scenario, results.reference) == nullptr) continue;
    for (const OrderingSpec& ordering : results.orderings) {
      const ScenarioOrderRecord* const order = find_order(scenario, ordering.name);
      if (order == nullptr || (against_reference && ordering.name == results.reference)) continue;
      row(scenario, *order);
    }
  }
}

/// Returns the title of an order, "VF Fiedler"; its name if it has no title.
inline std::string title_of(const StudyResults& results, std::string_view ordering) {
  for (const OrderingSpec& each : results.orderings) {
    if (each.name == ordering && !each.title.empty()) return each.title;
  }
  return std::string(ordering);
}

/// Seconds of each part of a scenario's steps: means over the runs. All methods have the same parts: making
/// the mesh and ordering it (fluids), work by element (assembly; ADMM's local step), the system of equations
/// (the solve; the global step), collisions, and the rest.
struct Phases {
  double mesh = 0;
  double order = 0;
  double elements = 0;
  double system = 0;
  double collision = 0;
  double other = 0;

  [[nodiscard]] double total() const { return mesh + order + elements + system + collision + other; }
};
inline Phases phases_of(const ScenarioOrderRecord& order) {
  Phases sum;
  for (const RunRecord& run : order.runs) {
    const StepReport::Seconds& s = run.seconds;
    const double share = 1.0 / static_cast<double>(order.runs.size());
    sum.mesh += share * s.triangulation;
    sum.order += share * s.order;
    sum.elements += share * (s.assembly + s.local);
    sum.system += share * (s.solve + s.global);
    sum.collision += share * s.collision;
    sum.other += share * std::max(0.0, s.total - s.triangulation - s.order - s.assembly - s.local - s.solve -
                                           s.global - s.collision);
  }
  return sum;
}

/// Returns the mean, over the runs, of the iterations of conjugate gradients plus ADMM.
inline double mean_iterations(const ScenarioOrderRecord& order) {
  double sum = 0;
  for (const RunRecord& run : order.runs) sum += static_cast<double>(run.cg_iterations + run.admm_iterations);
  return sum / static_cast<double>(order.runs.size());
}

}  // namespace meshorder
