// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "metrics/reuse_distance.hpp"

#include <cstdint>
#include <vector>

namespace meshorder {

/// Estimates the reuse distances of a stream from the accesses to some of its lines: a distance between
/// accesses to sampled lines, seen among these alone, is the share of the lines sampled of the true one
/// (Waldspurger, Park, Garthwaite and Ahmad 2015: Efficient MRC construction with SHARDS).
///
/// Sampled are blocks of five lines, by a hash of their number, of which the last three count: whether a
/// stream leads to one is seen on the two before. Five divides no period of a kernel's arrays, such as the 9
/// lines of 8 matrix blocks. Other accesses cost a hash each. The same stream gives the same
/// estimate on every run. Its error falls with the root of the lines sampled and of the cache's size:
/// estimates for caches below about 100 · 2^halvings lines are unreliable.
class ReuseSample {
 public:
  /// For accesses to lines 0 … lines − 1, of which 2^-halvings are sampled; 0 halvings measure exactly.
  ReuseSample(Index lines, int halvings);

  void access(Index line, Access how = Access::gathered) {
    if (place_of_block_.empty()) {
      reuse_.access(line, how);
    } else if (const Index block = line / kBlock; sampled(block)) {
      reuse_.access(kBlock * place_of_block_[block] + line % kBlock, how);
    }
  }

  /// As ReuseDistance::repeated, estimated for all lines.
  [[nodiscard]] Reuse repeated() &&;

 private:
  static constexpr Index kBlock = ReuseDistance::kSampledBlock;

  /// By mixed bits of its number, so that no stride of a stream falls in step with the sample.
  [[nodiscard]] bool sampled(Index block) const noexcept {
    std::uint32_t bits = static_cast<std::uint32_t>(block) * 0x9e3779b1U;
    bits = (bits ^ bits >> 15U) * 0x85ebca6bU;
    return (bits ^ bits >> 13U) >> (32 - halvings_) == 0;
  }

  [[nodiscard]] std::vector<Index> places(Index lines) const;

  [[nodiscard]] Index tracked_lines() const;

  int halvings_;
  std::vector<Index> place_of_block_;  ///< among the sampled ones; empty when all are
  ReuseDistance reuse_;
};

}  // namespace meshorder
