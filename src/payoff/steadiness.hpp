// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace meshorder {

/// How steadily the machine computed while kernels were timed. All 0 where nothing disturbed them.
struct Steadiness {
  double waiting = 0;  ///< share of the time in which the thread that was timed did not run
  double pace = 0;     ///< share by which a fixed piece of arithmetic took longer in the median than at best
  double repeat = 0;   ///< median share by which two timings of one kernel in one order differ

  bool operator==(const Steadiness&) const = default;
};

/// Returns why times taken so are unreliable, as a sentence; empty if they can be trusted: if no thread
/// waited for more than 5 % of the time, arithmetic took at most 10 % longer than at best, and timings of the
/// same differ by no more than the 5 % from which measured orders count as different.
std::string reason_to_doubt(const Steadiness& steadiness);

/// Returns the share by which the best of the even samples and the best of the odd ones differ; 0 for fewer
/// than two samples.
double repeat_difference(const std::vector<double>& samples);

/// Returns after how many runs, one after another, a kernel has settled in the caches: takes no more than 5 %
/// longer than the fastest of these runs; at least 1. A last cache that keeps only a part of what the second
/// level evicts takes up to ten runs to hold the data that is used again and again; the second of these
/// runs may be slower than the first.
int runs_to_settle(const std::vector<double>& seconds);

/// Returns whether the last three of at least four runs of a kernel took no more than 5 % longer than the
/// fastest one: it has settled.
bool is_steady(const std::vector<double>& seconds);

/// Collects the steadiness of a machine while it is measured.
class SteadinessWatch {
 public:
  /// Times a fixed piece of arithmetic, for some 0.3 ms.
  void tick();
  /// Adds elapsed seconds in which a thread was to compute, and the seconds in which it did.
  void add_sample(double seconds, double thread_seconds);
  /// Adds a `repeat_difference`.
  void add_repeat(double difference) { repeats_.push_back(difference); }

  [[nodiscard]] Steadiness result() const;

 private:
  double seconds_ = 0;
  double thread_seconds_ = 0;
  std::vector<double> ticks_;
  std::vector<double> repeats_;
};

/// Processor time of the calling thread since the object was made.
class ThreadStopwatch {
 public:
  [[nodiscard]] double seconds() const { return now() - start_; }

 private:
  static double now();
  double start_ = now();
};

}  // namespace meshorder
