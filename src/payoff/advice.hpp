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
#include <vector>

namespace meshorder {

/// Runs of each kernel in one time step of a linearised implicit solver, as kKernels lists them: it computes
/// forces and assembles once, and takes 100 iterations of conjugate gradients.
inline constexpr std::array<int, kKernels.size()> kRunsInTimeStep{100, 1, 1, 0};

/// Returns how often a kernel runs in what counts as a time step: of a matrix that is one product.
int runs_in_time_step(const Advice& advice, std::size_t kernel);

/// Returns the kernels that the advice is on, the first ones of kKernels (see `kernels_of` a mesh).
std::span<const Kernel> kernels_of(const Advice& advice);

struct AdviceOptions {
  std::vector<MeshMethods> methods = {};  ///< as in `PayoffOptions`
  MachineChoice machine = choose_machine();
  KernelSet kernels = KernelSet::plain;  ///< tuned ones are measured only
  int threads = 1;     ///< that share each run; to predict, as many as the machine's costs are of
  Caches caches = {};  ///< to predict for; empty: the machine's
  OrderOptions ordering = {};
  double graph_seconds = 0;  ///< time that the vertex graph took
  bool predict = true;
  bool describe = true;         ///< set the spans and the pattern of all candidates
  bool for_springs_too = true;  ///< add a candidate for springs if `auto` chooses another method for them
  std::optional<int> halvings =
      {};  ///< reuse is estimated from 2^-halvings of the lines; unset: `halvings_for`
  /// Of the mesh in its own order, where that is known; else it is computed.
  std::optional<KernelReuse> reuse_as_is = {};
  /// Time the kernels, in the mesh's order and in every candidate, in as many rounds as end within this
  /// number of seconds after the call, at least two; unset: do not time them.
  std::optional<double> measure_within = {};
  /// If above 0, only so many candidates stay: the first, and those predicted to be best for
  /// `ordering.workload`. Where there is a `race_timer`, it times them for half a second each, as long as
  /// memory allows them beside the mesh's own order, whatever `measure_within` says.
  std::size_t race_of = 0;
  OrderTimer race_timer = time_orders;
};

/// Computes the candidates and the times of the kernels in them and in the mesh's own order. `graph` is the
/// vertex graph of `mesh`. Throws InvalidArgument if neither prediction nor measurement is wanted, if the
/// machine's costs are of another number of threads, and if tuned kernels are to be predicted.
Advice advise(const Mesh& mesh, const CsrGraph& graph, const AdviceOptions& options = {});

/// Returns the factor up to which two times of a kernel count as equal: 1.05 for measured times and those
/// that the machine's own calibration predicts; by the costs of another machine 1.1 and for SpMV 1.25, where
/// smaller predicted differences were not confirmed by measurement (docs/prediction.md); and more where the
/// machine's own timings of one problem differ by more.
double same_time(const Advice& advice, Kernel kernel);

/// Returns the best candidate for each kernel, as kKernels lists them. Meshes without cells have nothing to
/// gain.
std::array<KernelAdvice, kKernels.size()> kernel_advice(const Advice& advice);

/// Returns how many times faster than in the mesh's own order the kernels of a workload run in a candidate:
/// that of one kernel, or the geometric mean of all.
double factor_for(Workload workload, const Advice& advice, std::size_t candidate);

/// Returns the place of the candidate in which the kernels of a workload run fastest, all of them or one; the
/// mesh's own order, and after it the first candidate, wins where no other is faster than that by more than
/// same_time, of all kernels its geometric mean. Nothing if the mesh's own order wins. Throws InvalidArgument
/// for `bandwidth` and `fill`, which times of kernels do not decide.
std::optional<std::size_t> winner_for(Workload workload, const Advice& advice);

/// Returns the milliseconds that a candidate saves in each time step (see runs_in_time_step), negative if it
/// is slower. Differences within same_time do not count.
double saved_in_time_step(const Advice& advice, std::size_t candidate);

/// Returns the time steps after which a candidate has paid for itself, 0 if it never does.
double steps_to_pay(const Advice& advice, std::size_t candidate);

/// Returns the command that gives a mesh the order of a candidate: "meshorder order --for springs"; of a
/// matrix it names the order of rows alone.
std::string command_for(const Candidate& candidate, bool is_matrix = false);

/// Returns the place in `candidates` of the order that the sentence on an advice names; nothing where nothing
/// is to be gained.
std::optional<std::size_t> advised(const Advice& advice);

/// Returns how many times faster the kernel that loses most runs in that order; nothing where nothing is to
/// be gained, and where by how much is in doubt.
std::optional<double> certain_gain(const Advice& advice);

/// Returns the place in kKernels of the kernel that a workload is about; kKernels.size() of those about all
/// or none.
std::size_t kernel_of(Workload workload);

/// Whether times of kernels decide what is best for a workload.
inline bool is_told_by_kernels(Workload workload) {
  return workload == Workload::all || kernel_of(workload) < kKernels.size();
}

/// Returns the workload if it is that of one kernel of the advice, else `all`.
Workload told_by_kernels(const Advice& advice, Workload workload);

/// Returns "hilbert", or "hilbert/original" where elements do not follow their vertices as `order` has them;
/// of a matrix the order of its rows.
std::string order_in_words(const Candidate& candidate, bool is_matrix = false);

/// Returns in one sentence which candidate was measured to be best for a workload, by how much, and when it
/// has paid for itself; or that none is better than the mesh's own order.
std::string comparison_in_words(const Advice& advice, Workload workload);

}  // namespace meshorder
