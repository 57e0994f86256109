// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/race.hpp"

#include "mesh/stored_matrix.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

namespace meshorder {
namespace {

/// Number of orders that are timed besides the mesh's own.
constexpr std::size_t kInRace = 3;

/// Returns the methods that take part, `auto` first. Entries of a matrix keep their order; methods that need
/// coordinates take part only if there are coordinates.
std::vector<MeshMethods> contenders(const Mesh& mesh) {
  const bool is_matrix = stored_matrix(mesh) != nullptr;
  const std::string elements = is_matrix ? "original" : "lexmax";
  std::vector<MeshMethods> result{{}};
  if (!is_matrix || has_places(mesh)) result.push_back({"hilbert-fronts", elements});
  for (const char* const method : {"spectral-fronts", "rcm", "bfs", "fiedler"})
    result.push_back({method, elements});
  return result;
}

std::string reason_for(const Race& race) {
  const std::size_t timed = race.factors.size();
  if (!is_measured(race.advice)) {
    if (!race.winner) {
      return fmt::format(
          "for {}, no order is predicted to be faster than the file's by more than the error of predictions",
          race.advice.machine);
    }
    return fmt::format(
        "predicted to be {:.2f} times as fast as the file's order for {}; no other order is predicted to be "
        "faster by more than the error of predictions",
        race.factors[*race.winner], race.advice.machine);
  }
  if (!race.winner) {
    return fmt::format(
        "none of {} orders timed here is faster than the file's by more than the variation of the times",
        timed);
  }
  return fmt::format(
      "{:.2f} times as fast as the file's order; none of {} orders timed here is faster by more than the "
      "variation of the times",
      race.factors[*race.winner], timed);
}

}  // namespace

MeshMethods Race::methods() const {
  if (!winner) return {"original", "original"};
  return {advice.candidates[*winner].vertices.name, advice.candidates[*winner].elements.name};
}

Race race(const Mesh& mesh, const CsrGraph& graph, const RaceOptions& options) {
  const Workload workload = options.ordering.workload;
  if (!is_judged_by_kernels(workload)) {
    throw InvalidArgument(fmt::format("race: no kernel measures {}", to_string(workload)));
  }
  Race result;
  result.advice = advise(mesh, graph,
                         {.methods = contenders(mesh),
                          .machine = options.machine,
                          .threads = options.machine.model.threads,
                          .ordering = options.ordering,
                          .format = options.format,
                          .graph_seconds = options.graph_seconds,
                          .race_of = kInRace,
                          .race_timer = options.timer});
  for (std::size_t i = 0; i < result.advice.candidates.size(); ++i) {
    result.factors.push_back(gain_for(workload, result.advice, i).ratio);
  }
  result.winner = winner_for(workload, result.advice);
  result.reason = reason_for(result);
  return result;
}

void give_reasons(const Race& race, MeshOrder& order) {
  order.vertices.method.reason = race.reason;
  order.cells.method.reason = fmt::format("{} together with the order of the vertices",
                                          is_measured(race.advice) ? "timed" : "predicted");
}

}  // namespace meshorder
