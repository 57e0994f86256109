// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/reuse_sample.hpp"

#include <cmath>
#include <utility>

namespace meshorder {

ReuseSample::ReuseSample(Index lines, int halvings)
    : halvings_(halvings),
      place_of_block_(halvings > 0 ? places(lines) : std::vector<Index>()),
      reuse_(halvings > 0 ? tracked_lines() : lines, halvings) {}

std::vector<Index> ReuseSample::places(Index lines) const {
  std::vector<Index> result(lines / kBlock + 1);
  Index next = 0;
  for (Index block = 0; block < index_size(result); ++block) {
    if (sampled(block)) result[block] = next++;
  }
  return result;
}

Index ReuseSample::tracked_lines() const {
  Index blocks = 0;
  for (Index block = 0; block < index_size(place_of_block_); ++block) blocks += sampled(block) ? 1 : 0;
  return kBlock * blocks;
}

void ReuseSample::measure_those_that_wait() {
  const std::size_t end = sampled_accesses_;
  for (std::size_t k = end - std::min(end, kWaiting / 2); k < end; ++k) find_among_sampled(waiting(k));
  for (std::size_t k = end - std::min(end, kWaiting); k < end; ++k) measure(waiting(k));
}

Reuse ReuseSample::repeated() && {
  measure_those_that_wait();
  Reuse reuse = std::move(reuse_).repeated();
  if (halvings_ == 0) return reuse;
  const double times = std::ldexp(1.0 * kBlock / (kBlock - ReuseDistance::kUncounted), halvings_);
  return {reuse.all.scaled(halvings_, times), reuse.jumps.scaled(halvings_, times)};
}

}  // namespace meshorder
