// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/steadiness.hpp"

#include "base/median.hpp"
#include "base/stopwatch.hpp"
#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>

namespace meshorder {
namespace {

constexpr double kMostWaiting = 0.05;
constexpr double kMostPace = 0.1;
constexpr double kMostRepeat = 0.05;
/// Returns the most seconds that a run of a settled kernel may take: 5 % more than the fastest run.
double most_when_settled(const std::vector<double>& seconds) {
  constexpr double kSettled = 1.05;
  return kSettled * *std::min_element(seconds.begin(), seconds.end());
}

/// Computes a chain of dependent operations, whose time depends only on the processor's clock rate.
std::uint64_t fixed_arithmetic() {
  constexpr int kSteps = 200'000;
  std::uint64_t value = 1;
  for (int step = 0; step < kSteps; ++step) value = value * 6364136223846793005U + 1442695040888963407U;
  return value;
}

}  // namespace

std::string reason_to_doubt(const Steadiness& steadiness) {
  std::vector<std::string> signs;
  if (steadiness.waiting > kMostWaiting)
    signs.push_back(fmt::format("{:.0f} % used by others", 100 * steadiness.waiting));
  if (steadiness.pace > kMostPace)
    signs.push_back(fmt::format("its speed changes by {:.0f} %", 100 * steadiness.pace));
  if (steadiness.repeat > kMostRepeat)
    signs.push_back(fmt::format("the same order timed twice differs by {:.0f} %", 100 * steadiness.repeat));
  return signs.empty() ? "" : "this machine is too busy to time kernels: " + join(signs);
}

int runs_to_settle(const std::vector<double>& seconds) {
  if (seconds.size() < 2) return 1;
  const double most = most_when_settled(seconds);
  const auto settled =
      std::find_if(seconds.begin() + 1, seconds.end(), [&](double of_run) { return of_run <= most; });
  return settled == seconds.end() ? 1 : static_cast<int>(settled - seconds.begin());
}

bool is_steady(const std::vector<double>& seconds) {
  constexpr std::ptrdiff_t kRuns = 3;
  if (std::ssize(seconds) <= kRuns) return false;
  const double most = most_when_settled(seconds);
  return std::all_of(seconds.end() - kRuns, seconds.end(), [&](double of_run) { return of_run <= most; });
}

double pace_seconds() {
  const Stopwatch stopwatch;
  [[maybe_unused]] volatile const std::uint64_t result = fixed_arithmetic();
  return stopwatch.seconds();
}

void SteadinessWatch::add_sample(double seconds, double thread_seconds) {
  seconds_ += seconds;
  thread_seconds_ += thread_seconds;
}

Steadiness SteadinessWatch::result() const {
  Steadiness result;
  if (seconds_ > 0) result.waiting = std::max(0.0, 1 - thread_seconds_ / seconds_);
  if (!ticks_.empty()) result.pace = median(ticks_) / *std::min_element(ticks_.begin(), ticks_.end()) - 1;
  result.repeat = median(repeats_);
  return result;
}

double ThreadStopwatch::now() {
  std::timespec time{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace meshorder
