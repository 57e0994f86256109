// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/comm/number_set.hpp"

#include <algorithm>
#include <bit>

namespace meshorder::distributed {
namespace {

constexpr GlobalIndex kBits = 64;

}  // namespace

NumberSet::NumberSet(std::span<const GlobalIndex> numbers) {
  if (numbers.empty()) return;
  const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
  first_ = *low;
  const auto words = static_cast<std::size_t>((*high - *low) / kBits) + 1;
  if (words > numbers.size()) {
    numbers_.assign(numbers.begin(), numbers.end());
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
    return;
  }
  words_.resize(words);
  for (const GlobalIndex number : numbers) {
    const GlobalIndex bit = number - first_;
    words_[static_cast<std::size_t>(bit / kBits)].bits |= std::uint64_t{1}
                                                          << static_cast<unsigned>(bit % kBits);
  }
  for (std::size_t w = 0; w < words; ++w) {
    words_[w].before = numbers_.size();
    for (std::uint64_t bits = words_[w].bits; bits != 0; bits &= bits - 1)
      numbers_.push_back(first_ + static_cast<GlobalIndex>(w) * kBits + std::countr_zero(bits));
  }
}

std::size_t NumberSet::position(GlobalIndex number) const {
  if (words_.empty()) {
    return static_cast<std::size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), number) -
                                    numbers_.begin());
  }
  const GlobalIndex bit = number - first_;
  const Word& word = words_[static_cast<std::size_t>(bit / kBits)];
  const std::uint64_t below = (std::uint64_t{1} << static_cast<unsigned>(bit % kBits)) - 1;
  return word.before + static_cast<std::size_t>(std::popcount(word.bits & below));
}

}  // namespace meshorder::distributed
