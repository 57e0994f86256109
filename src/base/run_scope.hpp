// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/options.hpp>

#include <chrono>
#include <string_view>

namespace meshorder {

/// The library call that the current thread is in. Reports the call's progress, and ends the call if the
/// caller's progress function asks for that.
///
/// The scope belongs to the thread that made the call. On other threads `poll` only checks whether their loop
/// is cancelled, so the loops of base/parallel.hpp call `poll` in every turn: the calling thread takes turns
/// too, and an exception on that thread cancels the loop on all threads. A call within a call (by a user's
/// own method) belongs to the outer call unless the `Run` of the inner call has a progress function or a time
/// limit.
class RunScope {
 public:
  explicit RunScope(const Run& run);
  ~RunScope();
  RunScope(const RunScope&) = delete;
  RunScope(RunScope&&) = delete;
  RunScope& operator=(const RunScope&) = delete;
  RunScope& operator=(RunScope&&) = delete;

 private:
  friend void report(std::string_view stage, double fraction);
  friend void poll();
  friend class TimeLimit;
  void tell();

  const Run& run_;
  RunScope* outer_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point told_ = start_;
  std::string_view stage_ = "check";
  double fraction_ = -1;
};

/// Reports the present stage of the calling thread's call, and the fraction of the call that is done: 0 … 1,
/// or −1 if unknown. A fraction below the last one is replaced by the last one. Calls the user's progress
/// function if its last call was 50 ms ago or more.
///
/// @throws Stopped if the progress function returns false, and the exceptions of that function
void report(std::string_view stage, double fraction = -1);

/// Calls the user's progress function if its last call was 50 ms ago or more. Costs a nanosecond if there is
/// no such function and no time limit, else a reading of the clock: call `poll` every 10 µs … 10 ms of work.
///
/// @throws as `report`; Stopped on a helping thread whose loop is cancelled
void poll();

/// Calls `poll` in every 1024th turn of a loop with short turns.
template <class Turn>
void poll_in_loop(Turn turn) {
  if (turn % 1024 == 0) poll();
}

/// The moment at which the calling thread's library call exceeds its time limit. Copies may be used on any
/// thread.
class TimeLimit {
 public:
  /// Takes the limit of the current thread's library call; no limit outside calls.
  TimeLimit();
  [[nodiscard]] bool is_over() const { return limited_ && std::chrono::steady_clock::now() >= end_; }

 private:
  bool limited_ = false;
  std::chrono::steady_clock::time_point end_;
};

}  // namespace meshorder
