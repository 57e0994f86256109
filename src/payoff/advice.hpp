// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "metrics/cache.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/machine_choice.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/payoff.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Runs of each kernel in one time step of a linearised implicit solver, in the order of kKernels. The solver
/// computes forces once, assembles once and takes 100 iterations of conjugate gradients.
inline constexpr std::array<int, kKernels.size()> kRunsInTimeStep{100, 1, 1, 0};

/// Returns how often a kernel runs in a time step: as in kRunsInTimeStep; for a matrix, 1.
int runs_in_time_step(const Advice& advice, std::size_t kernel);

/// Returns the kernels that the advice covers, a prefix of kKernels (see `kernels_of(const Mesh&)`).
std::span<const Kernel> kernels_of(const Advice& advice);

struct AdviceOptions {
  std::vector<MeshMethods> methods = {};  ///< as in `PayoffOptions`
  MachineChoice machine = choose_machine();
  KernelSet kernels = KernelSet::plain;  ///< tuned kernels can only be measured
  int threads = 1;                       ///< threads that share a run; `machine.model.threads` to predict
  Caches caches = {};                    ///< caches to predict for; empty: those of the machine
  OrderOptions ordering = {};
  std::string format = {};   ///< format in which the mesh will be written; empty: `Mesh::format`
  double graph_seconds = 0;  ///< time that building the vertex graph took
  bool predict = true;
  bool describe = true;         ///< set the spans and the pattern of all candidates
  bool for_springs_too = true;  ///< add a candidate for springs if `auto` chooses another method for them
  std::optional<int> halvings =
      {};  ///< reuse is estimated from 2^-halvings of the lines; unset: `halvings_for`
  /// The reuse in the mesh's own order, if known; computed if unset.
  std::optional<KernelReuse> reuse_as_is = {};
  /// If set, the kernels are timed within this many seconds of the call, in the mesh's own order and in every
  /// candidate: in as many rounds as fit, but at least two.
  std::optional<double> measure_within = {};
  /// If above 0, the number of candidates to keep: the first one, and those with the best predictions for
  /// `ordering.workload`. If `race_timer` is set, it times them and the mesh's own order for half a second
  /// each, as many at a time as memory allows; `measure_within` is ignored.
  std::size_t race_of = 0;
  OrderTimer race_timer = time_orders;
};

/// Computes the candidates, and the times of the kernels in each of them and in the mesh's own order. `graph`
/// is the vertex graph of `mesh`. Throws InvalidArgument if nothing is to be predicted or measured, for a
/// race without predictions, for predictions of tuned kernels, and if the costs are those of another number
/// of threads.
Advice advise(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options = {});

/// Returns the factor up to which two times of a kernel count as equal. It is 1.05 for measured times and for
/// predictions by the machine's own calibration. For predictions by the costs of another machine it is 1.1,
/// and 1.25 for SpMV: measurements did not confirm smaller predicted differences (docs/prediction.md). The
/// factor is larger if repeated timings of one problem on this machine differ by more.
double same_time(const Advice& advice, Kernel kernel);

/// Returns the best candidate for each kernel, in the order of kKernels. If there is nothing to gain, as for
/// a mesh without cells, the factor is 1.
std::array<KernelAdvice, kKernels.size()> kernel_advice(const Advice& advice);

/// Returns the speedup of a candidate over the mesh's own order: that of the workload's kernel or, for all
/// kernels, the geometric mean.
double factor_for(Workload workload, const Advice& advice, std::size_t candidate);

/// Returns the place of the candidate in which the kernels of a workload (one or all) run fastest; nothing if
/// no candidate is faster than the mesh's own order by more than same_time. The first candidate wins unless
/// another candidate is faster than it by more than same_time. For all kernels, geometric means are compared.
/// Throws InvalidArgument for workloads without kernels, such as `bandwidth` and `fill`.
std::optional<std::size_t> winner_for(Workload workload, const Advice& advice);

/// Returns the milliseconds that a candidate saves in each time step (see runs_in_time_step), negative if it
/// is slower. A kernel whose times differ by no more than same_time adds nothing.
double saved_in_time_step(const Advice& advice, std::size_t candidate);

/// Returns the time steps after which a candidate has paid for itself, 0 if it never does.
double steps_to_pay(const Advice& advice, std::size_t candidate);

/// Returns the command that gives a mesh the order of a candidate: "meshorder order --for springs". For a
/// matrix it names only the order of the rows.
std::string command_for(const Candidate& candidate, bool is_matrix = false);

/// Returns the place in `candidates` of the order that the advice recommends; nothing if there is nothing to
/// gain.
std::optional<std::size_t> advised(const Advice& advice);

/// Returns the speedup of the kernel that can gain most, in the order that `advised` returns; nothing if
/// there is nothing to gain or the size of the gain is in doubt.
std::optional<double> certain_gain(const Advice& advice);

/// Returns the place in kKernels of the workload's only kernel; kKernels.size() if the workload has all
/// kernels or none.
std::size_t kernel_of(Workload workload);

/// Returns whether times of kernels decide which order is best for a workload.
inline bool is_judged_by_kernels(Workload workload) {
  return workload == Workload::all || kernel_of(workload) < kKernels.size();
}

/// Returns the workload if it has exactly one kernel and the advice covers this kernel; else `all`.
Workload judged_by_kernels(const Advice& advice, Workload workload);

/// Returns the methods of a candidate: "hilbert", or "hilbert/original" if its elements are not in the
/// default order for its vertices. For a matrix, the order of its rows.
std::string order_in_words(const Candidate& candidate, bool is_matrix = false);

/// Returns a sentence that names the best measured candidate for a workload, its speedup and when it has paid
/// for itself; or that says that no order is better than the mesh's own.
std::string comparison_in_words(const Advice& advice, Workload workload);

}  // namespace meshorder
