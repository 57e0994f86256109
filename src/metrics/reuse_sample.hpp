// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/reuse_distance.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meshorder {

/// Estimates the reuse distances of a stream from the accesses to a sample of its lines: the distance counted
/// only in sampled lines is about the true distance times the share of lines that are sampled (Waldspurger,
/// Park, Garthwaite and Ahmad 2015: Efficient MRC construction with SHARDS).
///
/// The sample consists of blocks of eleven lines, chosen by a hash of the block's number. The last nine lines
/// of a block count; the first two show whether a stream continues into these nine. No period of a kernel's
/// arrays, such as the 9 lines of 8 matrix blocks, is a multiple of eleven. An access to a block that is not
/// sampled costs only a hash. The same stream gives the same estimate on every run. The estimate's error
/// falls with the square roots of the number of sampled lines and of the cache's size: estimates for caches
/// below about 100 · 2^halvings lines are unreliable.
class ReuseSample {
 public:
  /// For accesses to lines 0 … lines − 1, of which 2^-halvings are sampled. With 0 halvings the estimate is
  /// exact.
  ReuseSample(Index lines, int halvings);

  void access(Index line, Access how = Access::gathered) {
    streamed_ += how == Access::streamed ? 1 : 0;
    if (place_of_block_.empty()) {
      reuse_.access(line, how);
    } else if (const Index block = line / kBlock; sampled(block)) {
      __builtin_prefetch(&place_of_block_[block]);
      wait(line, how);
    }
  }

  /// Reports streamed accesses to the lines first … end − 1, one after another. O(end − first).
  void stream(Index first, Index end) {
    while (first < end) {
      const Index block = first / kBlock;
      const Index of_block = std::min(end, kBlock * (block + 1));
      if (place_of_block_.empty() || sampled(block)) {
        for (Index line = first; line < of_block; ++line) access(line, Access::streamed);
      } else {
        streamed_ += static_cast<std::uint32_t>(of_block - first);
      }
      first = of_block;
    }
  }

  /// Returns whether one of the lines first … last is sampled. Accesses to lines that are not sampled need
  /// not be reported. O(lines).
  [[nodiscard]] bool samples(Index first, Index last) const noexcept {
    if (place_of_block_.empty()) return true;
    for (Index block = first / kBlock; block <= last / kBlock; ++block) {
      if (sampled(block)) return true;
    }
    return false;
  }

  /// Like ReuseDistance::repeated, estimated for all lines.
  [[nodiscard]] Reuse repeated() &&;

 private:
  static constexpr Index kBlock = ReuseDistance::kSampledBlock;

  /// A sampled access, which is measured 32 sampled accesses later. Its block's entry is prefetched at once;
  /// its line's entry 16 sampled accesses later, when the line's number among the sampled lines is known.
  struct Waiting {
    Index line = 0;
    Access how = Access::gathered;
    std::uint32_t streamed = 0;  ///< number of streamed accesses before this access
  };
  static constexpr std::size_t kWaiting = 32;

  [[nodiscard]] Waiting& waiting(std::size_t number) { return waiting_[number % kWaiting]; }

  void wait(Index line, Access how) {
    if (sampled_accesses_ >= kWaiting) measure(waiting(sampled_accesses_));
    waiting(sampled_accesses_) = {line, how, streamed_};
    if (sampled_accesses_ >= kWaiting / 2) find_among_sampled(waiting(sampled_accesses_ - kWaiting / 2));
    ++sampled_accesses_;
  }

  void find_among_sampled(Waiting& access) {
    access.line = kBlock * place_of_block_[access.line / kBlock] + access.line % kBlock;
    reuse_.prefetch(access.line);
  }

  void measure(const Waiting& access) { reuse_.access(access.line, access.how, access.streamed); }

  void measure_those_that_wait();

  /// Returns whether a block is sampled. A hash decides, so that no stride of a stream fits the sample.
  [[nodiscard]] bool sampled(Index block) const noexcept {
    std::uint32_t bits = static_cast<std::uint32_t>(block) * 0x9e3779b1U;
    bits = (bits ^ bits >> 15U) * 0x85ebca6bU;
    return (bits ^ bits >> 13U) >> (32 - halvings_) == 0;
  }

  [[nodiscard]] std::vector<Index> places(Index lines) const;

  [[nodiscard]] Index tracked_lines() const;

  int halvings_;
  std::vector<Index> place_of_block_;        ///< place among the sampled blocks; empty if all are sampled
  std::array<Waiting, kWaiting> waiting_{};  ///< the latest sampled accesses; number k is at k % kWaiting
  std::size_t sampled_accesses_ = 0;
  std::uint32_t streamed_ = 0;
  ReuseDistance reuse_;
};

}  // namespace meshorder
