// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "payoff/cost_model.hpp"
#include "payoff/memory_probe.hpp"
#include "payoff/steadiness.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace meshorder {

/// Quality of the fit of the costs, by kernel in the order of kKernels.
struct FitQuality {
  std::array<double, kKernels.size()> condition{};  ///< condition_number of the fit's equations
  /// The median relative difference between predicted and measured times of the problems.
  std::array<double, kKernels.size()> error{};
  /// The median relative difference of two timings of one problem at different addresses. Smaller differences
  /// between times mean nothing.
  std::array<double, kKernels.size()> floor{};

  bool operator==(const FitQuality&) const = default;
};

/// The measurements of a machine from which times on it are predicted.
struct Calibration {
  CostModel
      model;  ///< on one thread; its caches are the caches found, with the reported sizes if these are close
  FitQuality quality;
  CostModel all_threads;  ///< on `threads` threads; the same as `model` if `threads` is 1
  FitQuality all_threads_quality;
  std::string processor;
  std::string build;  ///< version, compiler and options of the program
  std::string date;   ///< "2026-11-22", in UTC
  Caches reported;    ///< caches that the system reports; empty if it reports none
  FoundCaches found;
  int threads = 1;            ///< number of threads with which `all_threads` was measured
  double read_bandwidth = 0;  ///< GB/s, one thread
  double read_bandwidth_all = 0;
  Steadiness steadiness;
  double seconds = 0;  ///< duration of the calibration

  bool operator==(const Calibration&) const = default;
};

/// How thoroughly a machine is measured.
struct CalibrationEffort {
  double seconds = 16;  ///< each step is done once, and repeated only if that should end within this time
  Offset probed = Offset{256} << 20;  ///< size of the largest buffer that is read, bytes
  Index vertices = 200'000;           ///< number of vertices of the largest lattice
};

/// Returns the effort for `seconds` seconds. For less than half of the usual time, the lattices and buffers
/// are smaller, so that the last cache and the memory are measured less well.
CalibrationEffort effort_of(double seconds);

/// Measures this machine: its caches, latencies and bandwidths, and the kernels themselves on small lattices.
/// The vertices of the lattices are scrambled within windows, of sizes that fill half of each cache, so that
/// the misses of each level vary independently. Kernels run on the calling thread, timed by its processor
/// time, and then on all threads, timed by elapsed time; the least of several rounds counts. Costs are fitted
/// by non-negative least squares of relative errors. For products with the matrix, costs on all threads are
/// the costs on one thread times one factor. Calls `report` and `poll`.
Calibration measure_machine(const CalibrationEffort& effort = {});

/// A run of a kernel: its reuse and its time. On several threads the time is divided by `times_computed`.
struct TimedReuse {
  RunReuse reuse;
  double milliseconds = 0;
  int lattice = 0;  ///< number of the lattice; runs of one lattice share a part of their error
};

/// The costs of a kernel that fit its runs best.
struct FittedCosts {
  KernelCosts costs;
  double condition = 1;
  double error = 0;  ///< see FitQuality
};

/// The extra latency, in ns, of a dependent load (one that waits for the load before it) beyond each of
/// `sizes_that_cost`.
using Latencies = std::array<double, 4>;

/// Returns the extra latencies of dependent loads, at least 1 ns each. The last two are equal: each is half
/// of the difference between a load from memory and a load beyond the second size.
Latencies latencies_beyond(const FoundCaches& found, const Caches& caches);

/// Fits the costs of a kernel on a machine with these caches. Loads overlap, so a jump costs only a share of
/// its latency. An extra equation for each jump cost, with an eightieth of the weight of a run, says that all
/// jumps cost the same share. These equations decide if the runs have too few jumps. The error that all runs
/// of a lattice have in common has half the weight of each run's own error: costs serve to compare orders,
/// and the speed of memory that other programs also use changes from minute to minute.
///
/// @param like  for runs on all threads: costs of the same kernel on one thread, or null. An extra equation
///              for each cost, with two fifths of the weight of a run, says that the cost is the one-thread
///              cost times a factor that all costs share
FittedCosts fit_costs(std::span<const TimedReuse> runs, const Caches& caches, const Latencies& latencies,
                      const KernelCosts* like = nullptr);

/// Returns the costs times the one factor that fits the runs best.
FittedCosts scale_costs(std::span<const TimedReuse> runs, const KernelCosts& costs, const Caches& caches);

/// The result of a quick check of a machine against its calibration.
struct Recheck {
  std::array<double, kKernels.size()> ratio{};  ///< time now / predicted time, by kernel
  std::string moved;                            ///< reason to calibrate again; empty if there is none
  std::string doubt;                            ///< see reason_to_doubt
};

/// Runs the kernels on one small and one larger lattice, for some two seconds, and compares their times with
/// the calibration's predictions. The machine has changed if the median ratio of a kernel differs by more
/// than 15 % and by more than three times the sum of the calibration's error and floor.
Recheck recheck(const Calibration& calibration);

}  // namespace meshorder
