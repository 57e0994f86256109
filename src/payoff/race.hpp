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
  double graph_seconds = 0;                  ///< time that building the vertex graph took
  MachineChoice machine = choose_machine();  ///< its predictions choose the orders to time, on its threads
  OrderTimer timer = time_orders;            ///< empty: predictions decide
};

/// The result of timing or predicting several orders of a mesh.
struct Race {
  Advice advice;                      ///< its candidates are the orders that were timed, or predicted best
  std::vector<double> factors;        ///< as `factor_for` returns them, by candidate
  std::optional<std::size_t> winner;  ///< place of a candidate; nothing: the mesh's own order
  std::string reason;                 ///< why the winner won, a sentence

  /// Returns the methods of the winner; "original" if the mesh's own order won.
  [[nodiscard]] MeshMethods methods() const;
};

/// Times the kernels in a mesh's own order, in that of `auto` and in the two of five others with the best
/// predictions, for half a second each, and finds the fastest. Without a timer, predicted times decide.
/// `graph` is the vertex graph of `mesh`. Throws InvalidArgument for `bandwidth` and `fill`, which are not
/// about times of kernels.
Race race(const Mesh& mesh, const CsrGraph& graph, const RaceOptions& options = {});

/// Sets the reasons of an order that was computed by the methods of a race.
void give_reasons(const Race& race, MeshOrder& order);

}  // namespace meshorder
