// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace meshorder::fuzz {

inline constexpr std::size_t kTextRoom = 16;  ///< bytes by which a text within a file may grow

/// The choices of a mutation.
class Choice {
 public:
  explicit Choice(std::uint32_t seed) : random_(seed) {}

  /// Returns a number below `end`; 0 for 0.
  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

 private:
  std::minstd_rand random_;
};

}  // namespace meshorder::fuzz
