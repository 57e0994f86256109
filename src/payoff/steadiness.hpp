// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace meshorder {

/// How steadily the machine computed while kernels were timed. All numbers are 0 if nothing disturbed the
/// kernels.
struct Steadiness {
  double waiting = 0;  ///< share of the time in which the timed thread did not run
  double pace = 0;     ///< median / least time of a fixed piece of arithmetic, minus 1
  double repeat = 0;   ///< median relative difference between two timings of one kernel in the first order

  bool operator==(const Steadiness&) const = default;
};

/// Returns why the times are unreliable, "this machine is too busy to time kernels: 75 % used by others";
/// empty if they are reliable: the timed thread waited for at most 5 % of the time, arithmetic took at most
/// 10 % longer than at best, and two timings of one order differ by at most 5 %.
std::string reason_to_doubt(const Steadiness& steadiness);

/// Returns after how many successive runs, at least 1, a kernel has settled in the caches: the next run takes
/// at most 5 % longer than the fastest of `seconds`. 1 if no run does. Up to ten are needed if the last cache
/// keeps only a part of what the second level evicts; the second run may then be slower than the first.
int runs_to_settle(const std::vector<double>& seconds);

/// Returns whether a kernel has settled: it ran at least four times, and each of the last three runs took at
/// most 5 % longer than the fastest one.
bool is_steady(const std::vector<double>& seconds);

/// Returns the seconds of a fixed piece of arithmetic, some 0.3 ms: they grow if the processor is slowed
/// down.
double pace_seconds();

/// Collects the steadiness of a machine while it is measured.
class SteadinessWatch {
 public:
  void tick() { ticks_.push_back(pace_seconds()); }
  /// Adds the elapsed seconds of a sample and the processor time of its thread.
  void add_sample(double seconds, double thread_seconds);
  /// Adds the relative difference between two timings of one kernel in one order.
  void add_repeat(double difference) { repeats_.push_back(difference); }

  [[nodiscard]] Steadiness result() const;

 private:
  double seconds_ = 0;
  double thread_seconds_ = 0;
  std::vector<double> ticks_;
  std::vector<double> repeats_;
};

/// Measures the processor time of the calling thread since the object was made.
class ThreadStopwatch {
 public:
  [[nodiscard]] double seconds() const { return now() - start_; }

 private:
  static double now();
  double start_ = now();
};

}  // namespace meshorder
