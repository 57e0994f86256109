// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/parallel.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace meshorder {

/// A sample of the vertices: all vertices if there are fewer than 262,144, else one of every 2, 4, 8 …
/// consecutive vertices, 131,072 to 262,144 in all. A hash chooses each sampled vertex, so that the sample
/// does not follow the period of a lattice. The sample is the same in every run of the program.
class VertexSample {
 public:
  explicit VertexSample(Index vertices)
      : vertices_(vertices),
        bits_(std::max(0, static_cast<int>(std::bit_width(static_cast<std::uint32_t>(vertices))) - 18)) {}

  [[nodiscard]] bool is_all() const { return bits_ == 0; }
  /// Returns how many vertices are in the sample.
  [[nodiscard]] Index size() const { return chunk_count(vertices_, Index{1} << bits_); }
  /// Returns vertex k of the sample, k in 0 … size() − 1; ascending in k.
  [[nodiscard]] Index operator[](Index k) const {
    const std::uint64_t hash = static_cast<std::uint64_t>(k) * 0x9e3779b97f4a7c15U >> 32U;
    const auto place = static_cast<Index>(hash & ((std::uint64_t{1} << bits_) - 1));
    return std::min((k << bits_) + place, vertices_ - 1);
  }

 private:
  Index vertices_;
  int bits_;
};

}  // namespace meshorder
