// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "mesh/mesh.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

namespace meshorder {

// The number types of VTK's formats, in the order of the alternatives of Values.
inline constexpr std::array<std::string_view, std::variant_size_v<Values>> kVtuTypeNames{
    "Float64", "Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "String"};
inline constexpr std::array<std::string_view, std::variant_size_v<Values>> kVtkTypeNames{
    "double", "float",        "char",         "unsigned_char", "short", "unsigned_short",
    "int",    "unsigned_int", "vtktypeint64", "vtktypeuint64", "string"};

/// Empty values of the alternative with that number.
inline Values values_of_type(std::size_t alternative) {
  Values result;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (void)((I == alternative && (result.emplace<I>(), true)) || ...);
  }
  (std::make_index_sequence<std::variant_size_v<Values>>());
  return result;
}

/// Numbers as the integers that they are, `as` of each: {} when the values are no integers.
template <class Target>
std::vector<Target> integers_of(const Values& values) {
  return std::visit(
      [](const auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        std::vector<Target> result;
        if constexpr (std::is_integral_v<Number>) result.assign(numbers.begin(), numbers.end());
        return result;
      },
      values);
}

}  // namespace meshorder
