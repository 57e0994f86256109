// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/run_scope.hpp"

#include <meshorder/error.hpp>

#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

constexpr auto kBetweenReports = std::chrono::milliseconds(50);

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): the state of each thread
thread_local RunScope* innermost = nullptr;

/// Leaves the current call while the user's progress function runs: library calls that this function makes
/// are not part of that call and do not call the function again.
class OutsideOfCalls {
 public:
  OutsideOfCalls() : scope_(std::exchange(innermost, nullptr)) {}
  ~OutsideOfCalls() { innermost = scope_; }
  OutsideOfCalls(const OutsideOfCalls&) = delete;
  OutsideOfCalls(OutsideOfCalls&&) = delete;
  OutsideOfCalls& operator=(const OutsideOfCalls&) = delete;
  OutsideOfCalls& operator=(OutsideOfCalls&&) = delete;

 private:
  RunScope* scope_;
};

bool asks_for_nothing(const Run& run) { return !run.progress && std::isinf(run.time_limit); }

}  // namespace

RunScope::RunScope(const Run& run) : run_(run), outer_(innermost) {
  if (run.time_limit < 0 || std::isnan(run.time_limit)) {
    throw InvalidArgument("run: the time limit must be 0 or more seconds, or infinite");
  }
  if (!asks_for_nothing(run)) innermost = this;
}

RunScope::~RunScope() { innermost = outer_; }

void RunScope::tell() {
  const auto now = std::chrono::steady_clock::now();
  if (!run_.progress || now - told_ < kBetweenReports) return;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const OutsideOfCalls outside;
  if (!run_.progress({.stage = stage_, .fraction = fraction_, .seconds = seconds})) throw Stopped();
  // not `now`, which is out of date after a slow callback: every poll would then call back again
  told_ = std::chrono::steady_clock::now();
}

void report(std::string_view stage, double fraction) {
  if (innermost == nullptr) return;
  innermost->stage_ = stage;
  innermost->fraction_ = std::max(innermost->fraction_, fraction);
  innermost->tell();
}

void poll() {
  if (innermost != nullptr) return innermost->tell();
  // no scope on this thread: it may help in a loop that another thread has cancelled
  if (tbb::is_current_task_group_canceling()) throw Stopped();
}

TimeLimit::TimeLimit() {
  if (innermost == nullptr || std::isinf(innermost->run_.time_limit)) return;
  limited_ = true;
  // a longer limit could overflow the clock; 30 years are as good as no limit
  constexpr double kLongest = 1e9;
  const std::chrono::duration<double> limit(std::min(innermost->run_.time_limit, kLongest));
  end_ = innermost->start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit);
}

}  // namespace meshorder
