// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"
#include <meshorder/options.hpp>

#include <vector>

namespace meshorder::python {

/// Options as Python gives them: a dict with the names of `OrderOptions` and `Run`; what is not there has its
/// default. Keeps the arrays that the options view.
class Options {
 public:
  explicit Options(const nb::dict& given);
  [[nodiscard]] const OrderOptions& order() const { return order_; }
  [[nodiscard]] const Run& run() const { return order_.run; }

 private:
  OrderOptions order_;
  std::vector<Array> arrays_;
};

/// Counts a call that works without Python's lock, from before it gives the lock up until it has it again.
///
/// A thread that asks for the lock of an interpreter that ends is ended in the middle of C++, which ends the
/// process. So the interpreter waits at its exit for all calls, which stop as if their progress function had
/// said so (`wait_for_calls`).
class RunningCall {
 public:
  /// Throws Stopped if the interpreter ends.
  RunningCall();
  RunningCall(const RunningCall&) = delete;
  RunningCall(RunningCall&&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;
  RunningCall& operator=(RunningCall&&) = delete;
  ~RunningCall();
};

/// Stops all calls and waits for their end. No call begins afterwards.
void wait_for_calls();
/// In a process that was forked: the calls of other threads go on in the parent only.
void forget_calls();

/// Calls `work()` without Python's lock and returns its result. Other Python threads go on meanwhile.
template <class Work>
auto unlocked(const Work& work) {
  const RunningCall call;
  const nb::gil_scoped_release release;
  return work();
}

}  // namespace meshorder::python
