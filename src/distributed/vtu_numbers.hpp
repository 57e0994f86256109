// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/layout.hpp"
#include "io/vtk/vtk.hpp"

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <variant>
#include <vector>

/// Numbers in the bytes of .vtu files, in this machine's order, of the types that `vtk::kXmlTypeNames` lists.
namespace meshorder::distributed {

/// Returns the size in bytes of a number of an alternative of Values; 0 for texts.
inline Offset size_of_type(std::size_t alternative) {
  return std::visit(
      [](const auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        return std::is_arithmetic_v<Number> ? Offset{sizeof(Number)} : Offset{0};
      },
      vtk::values_of_type(alternative));
}

/// Calls `work` with a zero of the number type of an alternative of Values.
template <class Work>
void with_number_type(std::size_t alternative, const Work& work) {
  std::visit(
      [&](const auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        if constexpr (std::is_arithmetic_v<Number>) work(Number{});
      },
      vtk::values_of_type(alternative));
}

/// Converts the bytes of numbers of a type.
template <class Target>
std::vector<Target> numbers_of(const std::vector<std::byte>& bytes, std::size_t alternative) {
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

/// Returns the bytes of whole numbers in a type.
inline std::vector<std::byte> bytes_of(const std::vector<GlobalIndex>& numbers, std::size_t alternative) {
  std::vector<std::byte> result;
  with_number_type(alternative, [&](auto zero) {
    using Number = decltype(zero);
    result.resize(numbers.size() * sizeof(Number));
    std::byte* at = result.data();
    for (const GlobalIndex value : numbers) {
      const auto number = static_cast<Number>(value);
      std::memcpy(at, &number, sizeof(Number));
      at += sizeof(Number);
    }
  });
  return result;
}

}  // namespace meshorder::distributed
