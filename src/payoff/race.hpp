// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "payoff/advice.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/payoff.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace meshorder {

struct RaceOptions {
  OrderOptions ordering = {};                ///< the race is for `ordering.workload`
  std::string format = {};                   ///< format of the mesh's output; empty: `Mesh::format`
  double graph_seconds = 0;                  ///< time that building the vertex graph took
  MachineChoice machine = choose_machine();  ///< its predictions and threads are used
  OrderTimer timer = time_orders;            ///< empty: predictions decide
};

/// The result of timing or predicting several orders of a mesh.
struct Race {
  Advice advice;                      ///< candidates: the orders that were timed, or the best predicted ones
  std::vector<double> factors;        ///< ratios of `gain_for`, by candidate
  std::optional<std::size_t> winner;  ///< place of a candidate; nothing: the mesh's own order
  std::string reason;                 ///< why the winner won, a sentence

  /// Returns the methods of the winner; "original" if the mesh's own order won.
  [[nodiscard]] MeshMethods methods() const;
};

/// Times the kernels for half a second in each of these orders: the mesh's own, that of `auto`, and the two
/// of five others with the best predictions. Finds the fastest order. Without a timer, predicted times
/// decide. `graph` is the vertex graph of `mesh`. Throws InvalidArgument for workloads without kernels, such
/// as `bandwidth` and `fill`.
Race race(const Mesh& mesh, const CsrGraph& graph, const RaceOptions& options = {});

/// Sets the reasons of an order that was computed by the methods of a race.
void give_reasons(const Race& race, MeshOrder& order);

}  // namespace meshorder
