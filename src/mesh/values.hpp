// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/mesh.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder {

/// Returns the number of values, whatever their type.
inline std::size_t size_of(const Values& values) {
  return std::visit([](const auto& numbers) { return numbers.size(); }, values);
}

/// Calls `work` with the values and returns the result if they are numbers; for texts, returns `Result()`.
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

/// The same for integers only.
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

/// Returns whether values are of an integer type.
inline bool are_integers(const Values& values) {
  constexpr std::size_t kLastReal = 1;
  return values.index() > kLastReal && !are_texts(values);
}

/// Returns whether all numbers fit int32. O(numbers).
inline bool fit_32_bits(std::span<const std::int64_t> numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [](std::int64_t number) { return std::in_range<std::int32_t>(number); });
}

/// Returns the number of vertices or of cells of a mesh.
inline Index item_count(const Mesh& mesh, Association association) {
  return association == Association::vertices ? mesh.vertex_count() : mesh.cell_count();
}

/// Returns for each of `count` vertices or cells its row in the array, −1 if it has no row. Returns an empty
/// list for a dense array, in which vertex or cell i has row i. O(count).
std::vector<Index> rows_by_item(const DataArray& array, Index count);

/// Returns the given rows of an array's values, `components` values each; for row −1, missing values.
/// O(returned values).
Values rows_of_values(const Values& values, Index components, std::span<const Index> rows);

/// Makes an array dense if it has a row for each of `count` vertices or cells; its indices must be distinct.
/// O(values).
void make_dense(DataArray& array, Index count);

/// Appends values of the same type. O(values).
void append_values(Values& values, Values more);

/// Converts numbers to double; returns nothing for texts. O(values).
std::vector<double> as_reals(const Values& values);

/// Returns the value that is written for a missing value: NaN, 0 for integers, an empty text.
template <class Number>
Number missing_value() {
  if constexpr (std::is_floating_point_v<Number>) return std::numeric_limits<Number>::quiet_NaN();
  return Number{};
}

/// Returns an empty vector of the type with that index in Values.
inline Values values_of_type(std::size_t type) {
  Values result;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (void)((I == type && (result.emplace<I>(), true)) || ...);
  }
  (std::make_index_sequence<std::variant_size_v<Values>>());
  return result;
}

/// Returns a vector of the type with that index in Values; `fill` fills the vector.
template <class Fill>
Values values_of_type(std::size_t type, const Fill& fill) {
  Values values = values_of_type(type);
  std::visit(fill, values);
  return values;
}

/// Like `values_of_type`, but does not call `fill` for texts.
template <class Fill>
Values numbers_of_type(std::size_t type, const Fill& fill) {
  Values values = values_of_type(type);
  with_numbers(values, fill);
  return values;
}

/// Returns the size in bytes of a number of the type with that index in Values; 0 for texts.
inline std::int64_t size_of_type(std::size_t type) {
  return std::visit(
      [](const auto& numbers) {
        using Number = typename std::decay_t<decltype(numbers)>::value_type;
        return std::is_arithmetic_v<Number> ? static_cast<std::int64_t>(sizeof(Number)) : 0;
      },
      values_of_type(type));
}

}  // namespace meshorder
