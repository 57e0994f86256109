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
  double graph_seconds = 0;                  ///< time that the vertex graph took
  MachineChoice machine = choose_machine();  ///< whose predictions choose what is timed, on as many threads
  OrderTimer timer = time_orders;            ///< nothing: predictions decide
};

/// The result of timing or predicting other orders of a mesh than its own.
struct Race {
  Advice advice;                      ///< its candidates are the orders that were timed, or predicted best
  std::vector<double> factors;        ///< as `factor_for` returns them, by candidate
  std::optional<std::size_t> winner;  ///< place of a candidate; nothing: the mesh's own order
  std::string reason;                 ///< why that won, a sentence

  /// Returns the methods of the winner, "original" of the mesh's own order.
  [[nodiscard]] MeshMethods methods() const;
};

/// Times the kernels, in half a second an order, in a mesh's own order, in what `auto` takes and in the two
/// predicted to be the best of five others, and finds the fastest; without a timer, by predicted
/// times. `graph` is the vertex graph of `mesh`. Throws InvalidArgument for `bandwidth` and `fill`, which
/// times of kernels do not decide. O(the orders).
Race race(const Mesh& mesh, const CsrGraph& graph, const RaceOptions& options = {});

/// Says in an order by the methods of a race that this chose them.
void give_reasons(const Race& race, MeshOrder& order);

}  // namespace meshorder
