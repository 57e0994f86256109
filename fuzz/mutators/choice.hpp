// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cctype>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace meshorder::fuzz {

inline constexpr std::size_t kTextRoom = 16;  ///< bytes by which a text within a file may grow

/// Makes the choices of a mutation at random.
class Choice {
 public:
  explicit Choice(std::uint32_t seed) : random_(seed) {}

  /// Returns a number below `end`; 0 for 0.
  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

 private:
  std::minstd_rand random_;
};

/// Returns the name with one of its digits replaced by another; with a digit appended if it has none.
inline std::string near_name(std::string name, Choice& choice) {
  std::vector<std::size_t> digits;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(name[i])) != 0) digits.push_back(i);
  }
  if (digits.empty()) {
    digits.push_back(name.size());
    name += '0';
  }
  name[digits[choice.below(digits.size())]] = static_cast<char>('1' + choice.below(4));
  return name;
}

}  // namespace meshorder::fuzz
