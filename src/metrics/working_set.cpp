// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "metrics/measures.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace meshorder {

std::array<double, kElementsAtOnce.size()> working_sets(IncidenceRef elements,
                                                        std::span<const Index> new_to_old) {
  constexpr Index kPlaces = 8;
  constexpr Index kLargest = kElementsAtOnce.back();
  const Index count = elements.size();
  const Index windows = count / kLargest + (count % kLargest > 0 ? 1 : 0);
  const Index stride = std::max<Index>(1, windows / kPlaces);
  std::array<Offset, kElementsAtOnce.size()> distinct{};
  std::array<Offset, kElementsAtOnce.size()> counted{};
  std::vector<std::uint32_t> last_use(elements.vertex_count, ~0U);
  for (Index window = 0; window < windows; window += stride) {
    const Index begin = window * kLargest;
    const Index end = begin + std::min(kLargest, count - begin);
    for (std::size_t k = 0; k < kElementsAtOnce.size(); ++k) {
      counted[k] += (end - begin + kElementsAtOnce[k] - 1) / kElementsAtOnce[k];
    }
    for (Index place = begin; place < end; ++place) {
      const auto now = static_cast<std::uint32_t>(place);
      for (const Index v : elements[new_to_old.empty() ? place : new_to_old[place]]) {
        const std::uint32_t differing_bits = last_use[v] ^ now;
        last_use[v] = now;
        for (std::size_t k = 0; k < kElementsAtOnce.size(); ++k) {
          distinct[k] += differing_bits >= static_cast<std::uint32_t>(kElementsAtOnce[k]) ? 1 : 0;
        }
      }
    }
  }
  std::array<double, kElementsAtOnce.size()> means{};
  for (std::size_t k = 0; k < means.size(); ++k) {
    means[k] = static_cast<double>(distinct[k]) / static_cast<double>(std::max<Offset>(1, counted[k]));
  }
  return means;
}

}  // namespace meshorder
