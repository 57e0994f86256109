// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "mesh/values.hpp"

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

/// Conversions between bytes and numbers whose type is known only at run time. The type is given as the index
/// of an alternative of `Values`.
namespace meshorder::distributed {

/// Calls `work` with a 0 of the given number type; does nothing for texts.
template <class Work>
void with_number_type(std::size_t alternative, const Work& work) {
  std::visit(
      [&](const auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        if constexpr (std::is_arithmetic_v<Number>) work(Number{});
      },
      values_of_type(alternative));
}

/// Returns the bytes of numbers.
template <class Number>
[[nodiscard]] std::vector<std::byte> raw_bytes(std::span<const Number> numbers) {
  const auto bytes = std::as_bytes(numbers);
  return {bytes.begin(), bytes.end()};
}

/// Returns the bytes of values; none for texts.
[[nodiscard]] inline std::vector<std::byte> bytes_of_values(const Values& values) {
  return std::visit(
      [](const auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        if constexpr (std::is_arithmetic_v<Number>) return raw_bytes<Number>(numbers);
        return std::vector<std::byte>();
      },
      values);
}

/// Returns the numbers that `bytes` holds in a run-time type, converted to Target. O(bytes).
template <class Target>
[[nodiscard]] std::vector<Target> numbers_of(const std::vector<std::byte>& bytes, std::size_t alternative) {
  std::vector<Target> result;
  with_number_type(alternative, [&](auto zero) {
    using Number = decltype(zero);
    result.reserve(bytes.size() / sizeof(Number));
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(Number)) {
      Number number{};
      std::memcpy(&number, bytes.data() + at, sizeof(Number));
      result.push_back(static_cast<Target>(number));
    }
  });
  return result;
}

/// Returns the bytes of integers converted to a run-time type. O(numbers).
template <class Whole>
[[nodiscard]] std::vector<std::byte> bytes_of(const std::vector<Whole>& numbers, std::size_t alternative) {
  std::vector<std::byte> result;
  with_number_type(alternative, [&](auto zero) {
    using Number = decltype(zero);
    result.resize(numbers.size() * sizeof(Number));
    std::byte* at = result.data();
    for (const Whole value : numbers) {
      const auto number = static_cast<Number>(value);
      std::memcpy(at, &number, sizeof(Number));
      at += sizeof(Number);
    }
  });
  return result;
}

}  // namespace meshorder::distributed
