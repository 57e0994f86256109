// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/reuse_distance.hpp"

#include "base/random.hpp"
#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <list>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Mattson's stack as a plain list: all lines, the most recently used one first.
class Stack {
 public:
  /// Returns the line's place, −1 for a new line, and moves the line to the front.
  Index access(Index line) {
    const auto found = std::find(lines_.begin(), lines_.end(), line);
    const bool is_new = found == lines_.end();
    const auto distance = is_new ? -1 : static_cast<Index>(found - lines_.begin());
    if (is_new) {
      lines_.insert(lines_.begin(), line);
    } else {
      std::rotate(lines_.begin(), found, found + 1);
    }
    return distance;
  }

 private:
  std::vector<Index> lines_;
};

ReuseHistogram by_stack(const std::vector<Index>& stream, Stack stack = {}) {
  ReuseHistogram histogram;
  for (const Index line : stream) {
    const Index distance = stack.access(line);
    if (distance < 0) {
      histogram.add_cold();
    } else {
      histogram.add(distance);
    }
  }
  return histogram;
}

/// Jumps by definition. Far accesses are the cold ones and those at a distance of 512 lines or more. A far
/// access is a jump unless one of the two preceding lines in memory is among the last 64 far accesses.
ReuseHistogram jumps_by_stack(const std::vector<Index>& stream, Stack stack = {}) {
  ReuseHistogram histogram;
  std::vector<Index> far;
  for (const Index line : stream) {
    const Index distance = stack.access(line);
    if (distance >= 0 && distance < 512) continue;
    const auto first = far.end() - std::min<std::ptrdiff_t>(64, static_cast<std::ptrdiff_t>(far.size()));
    const bool led_to =
        std::any_of(first, far.end(), [&](Index f) { return f == line - 1 || f == line - 2; });
    far.push_back(line);
    if (led_to) continue;
    if (distance < 0) {
      histogram.add_cold();
    } else {
      histogram.add(distance);
    }
  }
  return histogram;
}

ReuseDistance measured(const std::vector<Index>& stream, Index lines) {
  ReuseDistance reuse(lines);
  for (const Index line : stream) reuse.access(line);
  return reuse;
}

/// The misses of a simulated LRU cache.
Offset misses_of_lru(const std::vector<Index>& stream, std::size_t capacity) {
  std::list<Index> order;
  std::unordered_map<Index, std::list<Index>::iterator> held;
  Offset misses = 0;
  for (const Index line : stream) {
    const auto found = held.find(line);
    if (found != held.end()) {
      order.splice(order.begin(), order, found->second);
      continue;
    }
    ++misses;
    order.push_front(line);
    held[line] = order.begin();
    if (order.size() > capacity) {
      held.erase(order.back());
      order.pop_back();
    }
  }
  return misses;
}

/// A random walk with leaps, which has reuses at all distances. It never accesses some of the lines.
std::vector<Index> wandering(Index lines, Index length, std::uint64_t seed) {
  Random random(seed);
  std::vector<Index> stream;
  Index line = 0;
  for (Index i = 0; i < length; ++i) {
    const std::uint64_t leap = std::uint64_t{1} << random.below(std::bit_width(static_cast<unsigned>(lines)));
    line = static_cast<Index>((static_cast<std::uint64_t>(line) + random.below(leap)) %
                              static_cast<std::uint64_t>(lines));
    stream.push_back(line - line % 3 / 2);
  }
  return stream;
}

std::vector<Index> count_up(Index lines, int times) {
  std::vector<Index> stream;
  for (int i = 0; i < times; ++i) {
    for (Index line = 0; line < lines; ++line) stream.push_back(line);
  }
  return stream;
}

TEST(ReuseDistance, IsThePlaceInTheStack) {
  // few lines for long streams: slots run out hundreds of times; many lines: counts have several levels
  for (const auto& [lines, length] :
       {std::pair(1, 50), {2, 500}, {40, 20000}, {1000, 30000}, {20000, test::kSanitized ? 30000 : 90000}}) {
    SCOPED_TRACE(lines);
    const std::vector<Index> stream = wandering(lines, length, 7);
    const ReuseDistance reuse = measured(stream, lines);
    EXPECT_EQ(reuse.reuse().all, by_stack(stream));
    EXPECT_EQ(reuse.reuse().all.accesses(), length);
    EXPECT_EQ(reuse.reuse().all.cold(), reuse.distinct());
  }
}

TEST(ReuseDistance, WhenRepeatedIsThatOfEveryLaterRun) {
  for (const auto& [lines, length] : {std::pair(1, 1), {50, 30}, {300, 20000}, {9000, 30000}}) {
    SCOPED_TRACE(lines);
    const std::vector<Index> stream = wandering(lines, length, 8);
    Stack stack;
    for (int run = 0; run < 2; ++run) {
      for (const Index line : stream) stack.access(line);
    }
    const ReuseHistogram repeated = measured(stream, lines).repeated().all;
    EXPECT_EQ(repeated, by_stack(stream, stack));
    EXPECT_EQ(repeated.cold(), 0);
    EXPECT_EQ(repeated.accesses(), length);
  }
}

TEST(ReuseDistance, JumpsWhereNoStreamLeads) {
  for (const auto& [lines, length] :
       {std::pair(600, 3000), {5000, 40000}, {20000, test::kSanitized ? 25000 : 60000}}) {
    SCOPED_TRACE(lines);
    const std::vector<Index> stream = wandering(lines, length, 11);
    EXPECT_EQ(measured(stream, lines).reuse().jumps, jumps_by_stack(stream));
  }
}

TEST(ReuseDistance, WhenRepeatedJumpsAsInEveryLaterRun) {
  const Index lines = 16000;
  const std::vector<Index> stream = wandering(lines, 40000, 12);
  Stack stack;
  for (const Index line : stream) stack.access(line);
  const ReuseHistogram later = jumps_by_stack(stream, stack);
  const ReuseHistogram repeated = measured(stream, lines).repeated().jumps;
  EXPECT_EQ(repeated.cold(), 0);
  for (const Offset capacity : {512, 2048, 8192}) {
    // equal except for accesses near the start: `later` lacks the far accesses of the previous run
    const auto expected = static_cast<double>(later.misses(capacity));
    EXPECT_GT(expected, 300.0);
    EXPECT_NEAR(static_cast<double>(repeated.misses(capacity)), expected, 0.01 * expected + 3.0) << capacity;
  }
}

TEST(ReuseDistance, OfASweepJumpsOnce) {
  const Index n = 3000;
  EXPECT_EQ(measured(count_up(n, 1), n).repeated().jumps.accesses(), 1);
  // 80 interleaved sweeps: each access comes too long after that to the preceding line
  std::vector<Index> interleaved;
  for (Index k = 0; k < 40; ++k) {
    for (Index sweep = 0; sweep < 80; ++sweep) interleaved.push_back(50 * sweep + k);
  }
  EXPECT_EQ(measured(interleaved, 4000).reuse().jumps.accesses(), 3200);
  std::vector<Index> few;
  for (Index k = 0; k < 400; ++k) {
    for (Index sweep = 0; sweep < 8; ++sweep) few.push_back(500 * sweep + k);
  }
  EXPECT_EQ(measured(few, 4000).reuse().jumps.accesses(), 8);
}

TEST(ReuseDistance, WhatAStreamComesToIsNoJumpButLeadsOn) {
  constexpr Index kLines = 4000;
  for (const Access how : {Access::streamed, Access::gathered}) {
    ReuseDistance reuse(kLines);
    for (Index line = 0; line < kLines; line += 4) reuse.access(line, how);
    EXPECT_EQ(reuse.reuse().jumps.accesses(), how == Access::streamed ? 0 : kLines / 4);
    // far again, and no predecessor among the last far accesses
    for (Index line = 0; line < kLines; line += 4) reuse.access(line, how);
    EXPECT_EQ(reuse.reuse().jumps.accesses(), how == Access::streamed ? 0 : kLines / 2);
    const Offset before = reuse.reuse().jumps.accesses();
    reuse.access(kLines - 3);
    EXPECT_EQ(reuse.reuse().jumps.accesses(), before);
    reuse.access(1);
    EXPECT_EQ(reuse.reuse().jumps.accesses(), before + 1);
  }
}

TEST(ReuseDistance, OfASweepIsAllOtherLines) {
  const Index n = 100000;
  const ReuseHistogram twice = measured(count_up(n, 2), n).reuse().all;
  EXPECT_EQ(twice.cold(), n);
  EXPECT_EQ(twice.accesses(), 2 * n);
  // 512 lines and their multiples by powers of two are exact capacities
  EXPECT_EQ(twice.misses(512 << 7), 2 * n);
  EXPECT_EQ(twice.misses(512 << 8), n);
  EXPECT_NEAR(twice.mean_log2(), std::log2(n), 0.006);
  EXPECT_EQ(measured(count_up(n, 1), n).repeated().all.misses(512 << 7), n);
}

TEST(ReuseDistance, OfASweepAndBackIsEveryDistanceOnce) {
  const Index n = 5000;
  std::vector<Index> stream = count_up(n, 1);
  for (Index line = n; line-- > 0;) stream.push_back(line);
  const ReuseHistogram histogram = measured(stream, n).reuse().all;
  for (const Index capacity : {0, 1, 100, 255, 256, 300, 2048, 4096}) {
    EXPECT_EQ(histogram.misses(capacity), 2 * n - capacity) << capacity;
  }
  double sum = 0.0;
  for (Index distance = 0; distance < n; ++distance) sum += std::log2(distance + 1.0);
  EXPECT_NEAR(histogram.mean_log2(), sum / n, 1e-4);
}

TEST(ReuseHistogram, HasTheMissesOfALeastRecentlyUsedCache) {
  const std::vector<Index> stream = wandering(30000, 200000, 9);
  const ReuseHistogram histogram = measured(stream, 30000).reuse().all;
  // caches of 32K, 48K, 256K, 1M and 1.25M, and small ones
  for (const std::size_t capacity : {1U, 17U, 255U, 512U, 768U, 4096U, 16384U, 20480U}) {
    EXPECT_EQ(histogram.misses(static_cast<Offset>(capacity)), misses_of_lru(stream, capacity)) << capacity;
  }
  EXPECT_EQ(histogram.misses(Offset{1} << 40), histogram.cold());
}

TEST(ReuseHistogram, RoundsOtherCapacitiesDownByLessThanAHundredth) {
  const std::vector<Index> stream = wandering(30000, 200000, 10);
  const ReuseHistogram histogram = measured(stream, 30000).reuse().all;
  for (const std::size_t capacity : {257U, 1001U, 4099U, 16385U, 29999U}) {
    EXPECT_GE(histogram.misses(static_cast<Offset>(capacity)), misses_of_lru(stream, capacity));
    EXPECT_LE(histogram.misses(static_cast<Offset>(capacity)), misses_of_lru(stream, capacity * 99 / 100));
  }
}

TEST(ReuseHistogram, HasTheMeanOfLogarithms) {
  ReuseHistogram histogram;
  EXPECT_EQ(histogram.mean_log2(), 0.0);
  histogram.add_cold();
  EXPECT_EQ(histogram.mean_log2(), 0.0);
  for (const Index distance : {0, 1, 3, 255}) histogram.add(distance);
  EXPECT_DOUBLE_EQ(histogram.mean_log2(), (0.0 + 1 + 2 + 8) / 4);

  ReuseHistogram large;
  double sum = 0.0;
  const std::vector<Index> distances{300, 1000, 54321, 1 << 20, 123456789, kMaxIndex};
  for (const Index distance : distances) {
    large.add(distance);
    sum += std::log2(distance + 1.0);
  }
  EXPECT_NEAR(large.mean_log2(), sum / static_cast<double>(distances.size()), 0.006);
}

TEST(ReuseDistance, OfNothingIsNothing) {
  ReuseDistance none(0);
  EXPECT_EQ(none.reuse(), Reuse());
  EXPECT_EQ(std::move(none).repeated(), Reuse());
}

}  // namespace
}  // namespace meshorder
