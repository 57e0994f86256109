// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"
#include <meshorder/options.hpp>

#include <optional>
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

/// A call that works without Python's lock: gives the lock up, and is counted until it has it again.
///
/// A thread that asks for the lock of an interpreter that ends is ended in the middle of C++, which ends the
/// process. So the interpreter waits at its exit for all calls, which stop as if their progress function had
/// said so (`wait_for_calls`). By then all other threads of Python are daemons: they never return to it, as
/// it may be gone, and an exception there would be written to a closed file.
class UnlockedCall {
 public:
  /// If the interpreter ends, throws Stopped in the thread that ends it and does not return in others.
  UnlockedCall();
  UnlockedCall(const UnlockedCall&) = delete;
  UnlockedCall(UnlockedCall&&) = delete;
  UnlockedCall& operator=(const UnlockedCall&) = delete;
  UnlockedCall& operator=(UnlockedCall&&) = delete;
  /// Does not return if the interpreter ends.
  ~UnlockedCall();

 private:
  std::optional<nb::gil_scoped_release> release_;
};

/// Stops all calls and waits for their end. No call begins afterwards.
void wait_for_calls();
/// In a process that was forked: the calls of other threads go on in the parent only.
void forget_calls();

/// Calls `work()` without Python's lock and returns its result. Other Python threads go on meanwhile.
template <class Work>
auto unlocked(const Work& work) {
  const UnlockedCall call;
  return work();
}

}  // namespace meshorder::python
