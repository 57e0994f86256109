// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"
#include "mesh/mesh_ordering.hpp"
#include "payoff/cost_model.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/machine.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace meshorder {

/// How often a solver of linearised implicit steps runs each kernel in one time step, as kKernels lists them:
/// it computes forces and assembles once, and takes a hundred iterations of conjugate gradients.
inline constexpr std::array<int, kKernels.size()> kRunsInTimeStep{100, 1, 1, 0};

/// What the kernels take in one order, in milliseconds.
struct OrderCosts {
  std::optional<KernelMilliseconds> predicted;
  std::optional<KernelMilliseconds> measured;  ///< the best of interleaved rounds

  /// Measured, or else predicted. One of them must be there.
  [[nodiscard]] const KernelMilliseconds& best_known() const { return measured ? *measured : *predicted; }
};

/// An order that the mesh could be given.
struct Candidate {
  Workload use = Workload::all;  ///< what `auto` chose it for
  MethodChoice vertex_method;
  MethodChoice element_method;
  double seconds = 0;  ///< what it costs: the graph, both orders, moving the mesh
  OrderCosts costs;
};

/// What reordering a mesh would be worth.
struct Advice {
  OrderCosts as_is;
  std::vector<Candidate> candidates;  ///< the first is what `meshorder order` does
};

/// Of one kernel.
struct KernelAdvice {
  std::size_t candidate = 0;  ///< the one in which it runs fastest
  double factor = 1;       ///< so many times longer it takes as the mesh is; 1 where there is nothing to gain
  double runs_to_pay = 0;  ///< after which the order has paid for itself; 0 where there is nothing to gain
};

struct AdviceOptions {
  Caches caches = caches_of_this_machine();
  OrderingOptions ordering = {};
  double graph_seconds = 0;  ///< what the vertex graph cost
  bool predict = true;
  bool for_springs_too = true;  ///< with a candidate for them where `auto` takes another method for these
  /// Reuse is estimated from 2^-halvings of the lines in meshes of `sample_from` simplices and more.
  int halvings = 3;
  Offset sample_from = 50'000;
  /// Kernels are timed, as the mesh is and in every candidate, in as many rounds as end by so many seconds
  /// after the call, but two at least; none: they are not timed.
  std::optional<double> measure_within = {};
};

/// Computes the orders that `auto` takes, and what the kernels take in them and in the order that the mesh
/// has; changes nothing. `graph` is the vertex graph of `mesh`. Predictions are the same on every run. Throws
/// InvalidArgument where neither prediction nor measurement is asked for.
Advice advise(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options = {});

/// Times of a kernel that differ by less than this factor are the same: measured ones by 1.05; predicted ones
/// by 1.1 and of products with the matrix by 1.25, since of smaller differences that the model saw in these,
/// too many were none (docs/prediction.md).
double same_time(Kernel kernel, bool predicted);

/// What the best candidate is worth for each kernel, as kKernels lists them. Meshes without cells have
/// nothing to gain.
std::array<KernelAdvice, kKernels.size()> kernel_advice(const Advice& advice);

/// The milliseconds that a candidate saves in each time step (see kRunsInTimeStep), below 0 where it loses;
/// differences that are none do not count.
double saved_in_time_step(const Advice& advice, std::size_t candidate);

}  // namespace meshorder
