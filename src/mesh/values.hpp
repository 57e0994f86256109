// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace meshorder {

/// Returns the number of values, whatever their type.
inline std::size_t size_of(const Values& values) {
  return std::visit([](const auto& numbers) { return numbers.size(); }, values);
}

/// Calls `work` with a list of numbers, not of texts. Returns its result; without a call, `Result()`.
template <class OfValues, class Work>
auto with_numbers(OfValues&& values, const Work& work) {
  using Result = decltype(work(std::get<std::vector<double>>(values)));
  return std::visit(
      [&](auto& list) {
        if constexpr (std::is_arithmetic_v<typename std::decay_t<decltype(list)>::value_type>) {
          return work(list);
        } else {
          return Result();
        }
      },
      values);
}

/// The same for a list of integers alone.
template <class OfValues, class Work>
auto with_integers(OfValues&& values, const Work& work) {
  using Result = decltype(work(std::get<std::vector<std::int64_t>>(values)));
  return std::visit(
      [&](auto& list) {
        if constexpr (std::is_integral_v<typename std::decay_t<decltype(list)>::value_type>) {
          return work(list);
        } else {
          return Result();
        }
      },
      values);
}

/// Returns whether values are texts, not numbers.
inline bool are_texts(const Values& values) {
  return std::holds_alternative<std::vector<std::string>>(values);
}

}  // namespace meshorder
