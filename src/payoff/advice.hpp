// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/text.hpp"
#include "graph/csr_graph.hpp"
#include "metrics/cache.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/machine_choice.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/payoff.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
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
  bool predict_in_doubt = false;  ///< predict if the measured times are unreliable
  bool describe = true;           ///< set all spans and patterns of the candidates; else only the means
  bool for_springs_too = true;    ///< add a candidate for springs if `auto` chooses another method for them
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

/// Returns whether measured times decide: there are some, and they are reliable.
bool is_measured(const Advice& advice);

/// Returns the geometric mean of ratios; its interval is the mean of theirs.
TimeRatio geometric_mean(std::span<const TimeRatio> ratios);

/// Returns the factor by which predicted times may be wrong. It is 1.05 for the machine's own calibration.
/// For the costs of another machine it is 1.1, and 1.25 for SpMV: measurements did not confirm smaller
/// predicted differences (docs/prediction.md). The factor is larger if repeated timings of one problem on
/// this machine differ by more. 1.05 also for times that were measured without rounds.
double same_time(const Advice& advice, Kernel kernel);

/// Returns how many times faster a kernel runs in a candidate's order than in the mesh's own: as measured if
/// the times are reliable, else as predicted, else a ratio without an interval.
TimeRatio gain_of(const Advice& advice, const Candidate& candidate, std::size_t kernel);

/// Return the same by one source alone; a ratio without an interval if there are no such times, or if the
/// measured ones are unreliable.
TimeRatio measured_gain(const Advice& advice, const Candidate& candidate, std::size_t kernel);
TimeRatio predicted_gain(const Advice& advice, const Candidate& candidate, std::size_t kernel);

/// How near neighbours are in an order, between `order`'s and random.
enum class OrderGrade : std::uint8_t { good, fair, poor };

template <>
struct EnumNames<OrderGrade> {
  static constexpr std::string_view kind = "grade";
  static constexpr std::array names{std::pair{OrderGrade::good, "good"}, std::pair{OrderGrade::fair, "fair"},
                                    std::pair{OrderGrade::poor, "poor"}};
};

/// Grades an order by the mean logarithm of its spans: from that of a better order on, up to a sixth of the
/// way to a random order is good, up to a half is fair, and the rest is poor.
OrderGrade grade_of(const Quality& as_is, const Quality& ordered, Index vertices);

/// Returns "poor: neighbours are 2,662 places apart on average; `meshorder order` makes it 304, random would
/// be 4,150" about the first candidate.
std::string grade_in_words(const Advice& advice, Index vertices);

/// Returns the best candidate for each kernel, in the order of kKernels. If there is nothing to gain, as for
/// a mesh without cells, the gain is {1, 1, 1}.
std::array<KernelAdvice, kKernels.size()> kernel_advice(const Advice& advice);

/// Returns the gain of a candidate for a workload: that of its kernel or, for all kernels, the geometric
/// mean, whose interval is the mean of theirs. Throws InvalidArgument for workloads without kernels, such as
/// `bandwidth`.
TimeRatio gain_for(Workload workload, const Advice& advice, std::size_t candidate);

/// Returns the place of the candidate in which the kernels of a workload (one or all) run fastest; nothing if
/// no candidate is told apart from the mesh's own order as faster. The first candidate wins if its ratio lies
/// in the interval of the best one. Throws as `gain_for`.
std::optional<std::size_t> winner_for(Workload workload, const Advice& advice);

/// Returns the milliseconds of a run in the mesh's own order: as measured if they are reliable or not
/// predicted.
double known_ms(const Advice& advice, std::size_t kernel);

/// Returns the milliseconds that a run in a candidate's order saves, negative if it is slower; 0 if the two
/// are not told apart.
double saved_ms(const Advice& advice, std::size_t candidate, std::size_t kernel);

/// Returns the time steps (see runs_in_time_step) after which a candidate has paid for itself, 0 if it never
/// does.
double steps_to_pay(const Advice& advice, std::size_t candidate);

/// Returns the command that gives a mesh the order of a candidate: "meshorder order --for springs". For a
/// matrix it names only the order of the rows.
std::string command_for(const Candidate& candidate, bool is_matrix = false);

/// Returns the place in `candidates` of the order that the advice recommends; nothing if there is nothing to
/// gain.
std::optional<std::size_t> advised(const Advice& advice);

/// Returns the gain of the kernel that can gain most, in the order that `advised` returns; nothing if no gain
/// is told apart.
std::optional<TimeRatio> certain_gain(const Advice& advice);

/// Returns the ends of the interval, such as "1.6 to 1.8", or one number if both are written alike.
std::string range_in_words(const TimeRatio& ratio);

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
