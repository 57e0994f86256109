// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/view.hpp>

#include <bit>
#include <cstdint>
#include <type_traits>

namespace meshorder {

/// A 64-bit hash that modifies FNV-1a: it takes words instead of bytes and folds in the upper half of its
/// state.
class Checksum {
 public:
  template <class Number>
  void add(Number number) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    if constexpr (std::is_floating_point_v<Number>) {
      mix(std::bit_cast<std::uint64_t>(static_cast<double>(number)));
    } else {
      mix(static_cast<std::uint64_t>(number));
    }
  }
  void add(const Point& point) {
    for (const double x : point) add(x);
  }
  template <class Range>
  void add_all(const Range& range) {
    add(range.size());
    for (const auto& entry : range) add(entry);
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

 private:
  void mix(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001B3U ^ (value_ >> 32U); }

  std::uint64_t value_ = 0xCBF29CE484222325U;
};

}  // namespace meshorder
