// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "payoff/cache_probe.hpp"
#include "payoff/cost_model.hpp"
#include "payoff/steadiness.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// How well the fit determines the costs, by kernel as kKernels lists them.
struct FitQuality {
  std::array<double, kKernels.size()> condition{};  ///< of the fit's equations, see condition_number
  /// The median share by which predicted times of the problems differ from measured ones.
  std::array<double, kKernels.size()> error{};
  /// The median share by which two timings of one problem at different addresses differ: a smaller
  /// difference of two times means nothing.
  std::array<double, kKernels.size()> floor{};

  bool operator==(const FitQuality&) const = default;
};

/// What was measured on a machine to predict times for it.
struct Calibration {
  CostModel
      model;  ///< on one thread; its caches are those found, the first ones as reported where they agree
  FitQuality quality;
  CostModel all_threads;  ///< on `threads` threads; the same as `model` where that is one
  FitQuality all_threads_quality;
  std::string processor;
  std::string build;  ///< version, compiler and options of the program
  std::string date;   ///< "2026-11-22", in UTC
  Caches reported;    ///< by the system; empty where it reports none
  FoundCaches found;
  int threads = 1;            ///< with which `all_threads` was measured
  double read_bandwidth = 0;  ///< GB/s, one thread
  double read_bandwidth_all = 0;
  Steadiness steadiness;
  double seconds = 0;  ///< that the calibration took

  bool operator==(const Calibration&) const = default;
};

/// How thoroughly a machine is measured.
struct CalibrationEffort {
  double seconds = 16;  ///< no measurement begins that is expected to end later, but each is made once
  Offset probed = Offset{256} << 20;  ///< largest buffer of loads, bytes
  Index vertices = 200'000;           ///< of the largest lattice
};

/// Returns the effort for so many seconds: with less than half of the usual time, smaller lattices and
/// buffers, which show less of the last cache and the memory.
CalibrationEffort effort_of(double seconds);

/// Measures this machine: its caches, latencies and bandwidths, and the kernels themselves on small lattices
/// whose vertices are scrambled within windows of half of each cache, so that each level's misses vary on
/// their own. Kernels run on the calling thread, and are timed by its processor time, the least of several
/// rounds; and then on all threads, by elapsed time. Costs are the non-negative least squares of relative
/// errors; those of products with the matrix on all threads are those on one, times one factor. Reports its
/// progress and polls.
Calibration measure_machine(const CalibrationEffort& effort = {});

/// A run of a kernel: its reuse, and its time; on several threads, divided by `times_computed`.
struct TimedReuse {
  RunReuse reuse;
  double milliseconds = 0;
  int lattice = 0;  ///< its number: runs of one lattice were timed side by side
};

/// The costs of a kernel that fit its runs best.
struct FittedCosts {
  KernelCosts costs;
  double condition = 1;
  double error = 0;  ///< see FitQuality
};

/// The extra latency of a load that waits for the one before, beyond each of the sizes that cost, ns.
using Latencies = std::array<double, 4>;

/// Returns these latencies, at least 1 ns each. The last two share equally what a load from memory takes
/// longer than one beyond the second size.
Latencies latencies_behind(const FoundCaches& found, const Caches& caches);

/// Fits the costs of a kernel on a machine with such caches. Loads do not wait for each other, so that a jump
/// costs a share of its latency. Where runs have too few jumps to show what they cost, it is the same share
/// as of the others: the equations say so, with an eightieth of the weight of a run each. The error that all
/// runs of a lattice have in common has half the weight of each run's own: costs are for ratios,
/// and the rate of a shared memory changes from minute to minute.
///
/// @param like  costs of the same kernel on one thread where the runs are on all threads, or null. Unless the
///              runs show otherwise, all costs are those, times one factor: an equation for each says so,
///              with two fifths of the weight of a run
FittedCosts fit_costs(std::span<const TimedReuse> runs, const Caches& caches, const Latencies& latencies,
                      const KernelCosts* like = nullptr);

/// Fits one factor to the runs, by which all of the costs are multiplied.
FittedCosts scale_costs(std::span<const TimedReuse> runs, const KernelCosts& costs, const Caches& caches);

/// What a quick check of a machine finds changed since its calibration.
struct Recheck {
  std::array<double, kKernels.size()> ratio{};  ///< time now / predicted time, by kernel
  std::string moved;                            ///< why the calibration should be done anew, or empty
  std::string doubt;                            ///< as of reason_to_doubt
};

/// Runs the kernels on one small and one larger lattice, in some two seconds, and compares their times with
/// those that the calibration predicts. The machine has moved where a kernel's times differ by more than 15 %
/// and three times the calibration's own error and floor.
Recheck recheck(const Calibration& calibration);

}  // namespace meshorder
