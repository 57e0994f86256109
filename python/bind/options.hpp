// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "arrays.hpp"
#include <meshorder/options.hpp>

#include <optional>
#include <vector>

namespace meshorder::python {

/// Options from a dict of Python with the names of `OrderOptions` and `Run`; missing ones have their
/// defaults. Owns the arrays that the options view.
class Options {
 public:
  explicit Options(const nb::dict& given);
  [[nodiscard]] const OrderOptions& order() const { return order_; }
  [[nodiscard]] const Run& run() const { return order_.run; }

 private:
  OrderOptions order_;
  std::vector<Array> arrays_;
};

/// A call without Python's lock: releases the lock, and is counted until it has the lock again.
///
/// Python ends a thread that asks for the lock while the interpreter ends. In the middle of C++ this ends the
/// process. So the interpreter waits at its exit for all calls, which stop as if their progress function had
/// returned False (`wait_for_calls`). All other threads of Python are daemons then: they never return to the
/// interpreter, which may be gone, and an exception there would be written to a closed file.
class UnlockedCall {
 public:
  /// If the interpreter ends: throws Stopped in the thread that ends it, and never returns in others.
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
/// For a forked process: forgets the calls of other threads, which continue in the parent only.
void forget_calls();

/// Calls `work()` without Python's lock and returns its result. Other Python threads run meanwhile.
template <class Work>
auto unlocked(const Work& work) {
  const UnlockedCall call;
  return work();
}

}  // namespace meshorder::python
