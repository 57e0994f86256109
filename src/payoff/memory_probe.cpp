// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "payoff/memory_probe.hpp"

#include "base/parallel.hpp"
#include "base/run_scope.hpp"
#include "base/stopwatch.hpp"
#include "kernels/aligned.hpp"
#include "metrics/cache.hpp"
#include "payoff/least_squares.hpp"
#include "payoff/steadiness.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace meshorder {
namespace {

constexpr Offset kKilobyte = Offset{1} << 10;
constexpr Offset kSmallest = 8 * kKilobyte;
constexpr std::uint64_t kLineWords = kLineBytes / sizeof(std::uint64_t);

/// Makes `steps` loads, each of which waits for the load before it, at random lines among the first `lines`
/// of a buffer of zeros. Without `Load` it does only the arithmetic between the loads.
template <bool Load>
std::uint64_t follow(const std::uint64_t* buffer, std::uint64_t lines, int steps, std::uint64_t state) {
  for (int step = 0; step < steps; ++step) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const std::uint64_t line = ((state >> 32) * lines) >> 32;
    std::uint64_t value = line >> 63;  // this is 0, but the compiler cannot know that
    if constexpr (Load) value = buffer[line * kLineWords];
    asm volatile("" : "+r"(value));
    state += value;
  }
  return state;
}

template <bool Load>
double seconds_of(const std::uint64_t* buffer, std::uint64_t lines, int steps, std::uint64_t seed) {
  const ThreadStopwatch stopwatch;
  std::uint64_t state = follow<Load>(buffer, lines, steps, seed);
  asm volatile("" : "+r"(state));
  return stopwatch.seconds() / steps;
}

/// Reads one word of each line of the last `most` bytes (or of all bytes, if there are fewer), twice.
void fill_caches(std::span<const std::uint64_t> words, std::size_t most) {
  const std::size_t skipped = words.size() - std::min(words.size(), most / sizeof(std::uint64_t));
  for (int pass = 0; pass < 2; ++pass) {
    std::uint64_t sum = 0;
    for (std::size_t i = skipped; i < words.size(); i += kLineWords) sum += words[i];
    asm volatile("" : "+r"(sum));
  }
}

/// Cache levels that explain the measured latencies.
struct Explanation {
  std::vector<std::size_t> sizes;  ///< for each level, the index of the probe point with its size; ascending
  std::vector<double> costs;       ///< ns: a hit in the first level, then what missing each level adds
  double error = std::numeric_limits<double>::infinity();  ///< the sum of squares of relative errors
};

Explanation explained(std::span<const ProbePoint> points, const std::vector<std::size_t>& sizes) {
  Rows rows{.columns = sizes.size() + 1};
  for (const ProbePoint& point : points) {
    rows.values.push_back(1 / point.nanoseconds);
    for (const std::size_t size : sizes) {
      const double hits = static_cast<double>(points[size].bytes) / static_cast<double>(point.bytes);
      rows.values.push_back(std::max(0.0, 1 - hits) / point.nanoseconds);
    }
  }
  const std::vector<double> ones(points.size(), 1.0);
  Explanation result{sizes, non_negative_least_squares(rows, ones), 0};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double rest = -1;
    for (std::size_t j = 0; j < rows.columns; ++j) rest += rows[i][j] * result.costs[j];
    result.error += rest * rest;
  }
  return result;
}

/// Returns whether each level is a cache, not an effect of page tables or a disturbance: missing it must add
/// more than a quarter to the latency.
bool has_steps(const Explanation& explanation) {
  constexpr double kLeastStep = 0.25;
  double before = explanation.costs.front();
  for (std::size_t i = 1; i < explanation.costs.size(); ++i) {
    if (!(explanation.costs[i] > kLeastStep * before)) return false;
    before += explanation.costs[i];
  }
  return true;
}

/// Returns the best explanation by that many levels; its error is infinite if no explanation passes
/// has_steps.
Explanation best_explanation(std::span<const ProbePoint> points, std::size_t levels) {
  Explanation best;
  std::vector<std::size_t> sizes(levels);
  const auto choose = [&](const auto& choose_next, std::size_t level, std::size_t from) -> void {
    if (level == levels) {
      Explanation tried = explained(points, sizes);
      if (tried.error < best.error && has_steps(tried)) best = std::move(tried);
      return;
    }
    for (std::size_t size = from; size + 1 < points.size(); ++size) {
      sizes[level] = size;
      // a next cache is at least twice as large
      std::size_t next = size + 1;
      while (next < points.size() && points[next].bytes < 2 * points[size].bytes) ++next;
      choose_next(choose_next, level + 1, next);
    }
  };
  choose(choose, 0, 0);
  return best;
}

}  // namespace

std::vector<Offset> probe_sizes(Offset largest) {
  std::vector<Offset> sizes;
  for (int i = 0;; ++i) {
    const double bytes = static_cast<double>(kSmallest) * std::exp2(i / 3.0);
    const Offset whole = std::llround(bytes / kLineBytes) * kLineBytes;
    if (whole > largest) break;
    sizes.push_back(whole);
  }
  return sizes;
}

std::vector<ProbePoint> probe_latencies(std::span<const Offset> sizes, int rounds,
                                        const std::function<void(double)>& tell) {
  if (sizes.empty()) return {};
  // few steps, so that other programs do not interrupt most runs
  constexpr int kSteps = 20'000;
  constexpr std::size_t kMostFilled = std::size_t{64} << 20;
  const auto largest = static_cast<std::size_t>(*std::max_element(sizes.begin(), sizes.end()));
  const AlignedVector<std::uint64_t> buffer(largest / sizeof(std::uint64_t), 0);
  std::vector<ProbePoint> result;
  for (const Offset bytes : sizes) result.push_back({bytes, std::numeric_limits<double>::infinity()});
  double arithmetic = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      poll();
      if (tell) {
        tell((static_cast<double>(round) + static_cast<double>(i) / static_cast<double>(sizes.size())) /
             rounds);
      }
      const auto lines = static_cast<std::uint64_t>(std::max<Offset>(1, sizes[i] / kLineBytes));
      arithmetic = std::min(arithmetic, seconds_of<false>(buffer.data(), lines, kSteps, 1));
      // fill the caches with lines of this part of the buffer
      fill_caches(std::span(buffer).first(static_cast<std::size_t>(lines) * kLineWords), kMostFilled);
      const double seconds =
          seconds_of<true>(buffer.data(), lines, kSteps, 2 * static_cast<std::uint64_t>(round) + 1);
      result[i].nanoseconds = std::min(result[i].nanoseconds, 1e9 * seconds);
    }
  }
  for (ProbePoint& point : result) {
    point.nanoseconds = std::max(0.1, point.nanoseconds - 1e9 * arithmetic);
  }
  return result;
}

FoundCaches find_caches(std::span<const ProbePoint> points, std::size_t most) {
  if (points.empty()) throw InvalidArgument("caches: no latencies are given");
  Explanation best = explained(points, {});
  for (std::size_t levels = 1; levels <= most; ++levels) {
    // one more level must reduce the error by more than a quarter
    constexpr double kLeastGain = 0.75;
    Explanation next = best_explanation(points, levels);
    if (next.error < kLeastGain * best.error) best = std::move(next);
  }
  FoundCaches found;
  found.memory_nanoseconds = best.costs.front();
  for (std::size_t i = 0; i < best.sizes.size(); ++i) {
    const Offset bytes = points[best.sizes[i]].bytes;
    found.levels.push_back({bytes / kKilobyte * kKilobyte, found.memory_nanoseconds});
    found.memory_nanoseconds += best.costs[i + 1];
  }
  if (found.levels.empty()) {
    found.levels.push_back({points.back().bytes / kKilobyte * kKilobyte, found.memory_nanoseconds});
  }
  return found;
}

double read_bandwidth(std::size_t buffer_bytes, int passes, int threads) {
  // integers: the compiler may sum them with vector instructions, but not floating-point numbers
  const AlignedVector<std::uint64_t> buffer(std::max<std::size_t>(1, buffer_bytes / sizeof(std::uint64_t)),
                                            1);
  const auto parts = static_cast<std::size_t>(std::max(1, threads));
  double best = 0.0;
  for (int pass = 0; pass < passes; ++pass) {
    const Stopwatch stopwatch;
    for_each_part(static_cast<Index>(parts), [&](Index part) {
      const std::size_t end = buffer.size() * (static_cast<std::size_t>(part) + 1) / parts;
      std::uint64_t sum = 0;
      for (std::size_t i = buffer.size() * static_cast<std::size_t>(part) / parts; i < end; ++i) {
        sum += buffer[i];
      }
      // forces the compiler to compute the sum before the clock is read
      asm volatile("" : "+r"(sum) : : "memory");
    });
    const double seconds = std::max(stopwatch.seconds(), 1e-9);
    best = std::max(best, static_cast<double>(buffer.size() * sizeof(std::uint64_t)) / seconds);
  }
  return 1e-9 * best;
}

}  // namespace meshorder
