// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/reorder.hpp"
#include "payoff/cost_model.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/machine.hpp"
#include <meshorder/mesh.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace meshorder {

/// Runs of each kernel in one time step of a linearised implicit solver, as kKernels lists them: it computes
/// forces and assembles once, and takes 100 iterations of conjugate gradients.
inline constexpr std::array<int, kKernels.size()> kRunsInTimeStep{100, 1, 1, 0};

/// Times of the kernels in one order, in milliseconds.
struct OrderCosts {
  std::optional<KernelMilliseconds> predicted;
  std::optional<KernelMilliseconds> measured;  ///< best of interleaved rounds

  /// Returns the measured times, else the predicted ones. One of them must be set.
  [[nodiscard]] const KernelMilliseconds& best_known() const { return measured ? *measured : *predicted; }
};

/// An order for the mesh.
struct Candidate {
  Workload use = Workload::all;  ///< the kernel that `auto` chose it for
  MethodChoice vertex_method;
  MethodChoice element_method;
  double seconds = 0;  ///< its cost: the graph, both orders, moving the mesh
  OrderCosts costs;
};

/// Times of a mesh in its own order and in others.
struct Advice {
  OrderCosts as_is;
  std::vector<Candidate> candidates;  ///< the first is the default of `meshorder order`
};

/// The best candidate for one kernel.
struct KernelAdvice {
  std::size_t candidate = 0;  ///< index of the candidate in which it runs fastest
  double factor =
      1;  ///< its time in the mesh's order divided by that in the candidate; 1 if nothing is gained
  double runs_to_pay = 0;  ///< runs after which the order has paid for itself; 0 if nothing is gained
};

struct AdviceOptions {
  Caches caches = caches_of_this_machine();
  OrderOptions ordering = {};
  double graph_seconds = 0;  ///< time that the vertex graph took
  bool predict = true;
  bool for_springs_too = true;  ///< add a candidate for springs if `auto` chooses another method for them
  /// Reuse is estimated from 2^-halvings of the lines for meshes of at least `sample_from` simplices.
  int halvings = 3;
  Offset sample_from = 50'000;
  /// Time the kernels, in the mesh's order and in every candidate, in as many rounds as end within so many
  /// seconds after the call, at least two; unset: do not time them.
  std::optional<double> measure_within = {};
};

/// Computes the orders that `auto` chooses, and the times of the kernels in them and in the mesh's own order.
/// `graph` is the vertex graph of `mesh`. Predictions are the same on every run. Throws InvalidArgument if
/// neither prediction nor measurement is wanted.
Advice advise(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options = {});

/// Returns the factor up to which two times of a kernel count as equal: 1.05 for measured times; 1.1 for
/// predicted ones and 1.25 for SpMV, where smaller predicted differences were not confirmed by measurement
/// (docs/prediction.md).
double same_time(Kernel kernel, bool predicted);

/// Returns the best candidate for each kernel, as kKernels lists them. Meshes without cells have nothing to
/// gain.
std::array<KernelAdvice, kKernels.size()> kernel_advice(const Advice& advice);

/// Returns the milliseconds that a candidate saves in each time step (see kRunsInTimeStep), negative if it is
/// slower. Differences within same_time do not count.
double saved_in_time_step(const Advice& advice, std::size_t candidate);

}  // namespace meshorder
