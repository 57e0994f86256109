// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <ranges>
#include <type_traits>

namespace meshorder {
inline namespace v0_3 {

/// An integer type that views and spans accept: 32 or 64 bits, signed or not, neither bool nor a character
/// type.
template <class T>
concept IndexType = std::integral<T> && !std::same_as<T, bool> && !std::same_as<T, wchar_t> &&
                    !std::same_as<T, char32_t> && (sizeof(T) == 4 || sizeof(T) == 8) && !std::is_const_v<T>;

/// A floating-point type that views accept.
template <class T>
concept RealType = std::same_as<T, float> || std::same_as<T, double>;

/// An integer type that counts entries.
template <class N>
concept CountType = std::integral<N> && !std::same_as<N, bool>;

}  // namespace v0_3
}  // namespace meshorder

/// Parts of the public headers that may change at any time.
namespace meshorder {
inline namespace v0_3 {
namespace detail {

/// Traits of the values of a range: numbers, or std::array of `width` numbers.
template <class T>
struct Row {
  using Number = T;
  static constexpr std::size_t width = 1;
  static constexpr bool is_array = false;
};

template <class T, std::size_t N>
struct Row<std::array<T, N>> {
  static_assert(N > 0 && sizeof(std::array<T, N>) == N * sizeof(T));
  using Number = T;
  static constexpr std::size_t width = N;
  static constexpr bool is_array = true;
};

template <class R>
concept Contiguous = std::ranges::contiguous_range<R> && std::ranges::sized_range<R>;

template <class R>
using RowOf = Row<std::ranges::range_value_t<R>>;

template <class R>
concept IndexRange = Contiguous<R> && IndexType<typename RowOf<R>::Number>;

template <class R>
concept RealRange = Contiguous<R> && RealType<std::ranges::range_value_t<R>>;

template <class R>
concept PointRange =
    Contiguous<R> && RowOf<R>::is_array && RealType<typename RowOf<R>::Number> && RowOf<R>::width <= 3;

/// A range that outlives the expression and whose values are not const.
template <class R>
concept Writable = Contiguous<R> && std::ranges::borrowed_range<R> &&
    !std::is_const_v<std::remove_reference_t<std::ranges::range_reference_t<R>>>;

/// A view such as std::span, which does not own its array.
template <class R>
concept Borrowed = std::ranges::enable_borrowed_range<std::remove_cvref_t<R>>;

/// Returns a pointer to the first number of a range of numbers or of arrays of numbers; unspecified for an
/// empty range.
template <class R>
auto first_number(R&& range) noexcept {
  using Value = std::remove_pointer_t<decltype(std::ranges::data(range))>;
  using Number = typename Row<std::remove_const_t<Value>>::Number;
  using Target = std::conditional_t<std::is_const_v<Value>, const Number, Number>;
  if constexpr (RowOf<R>::is_array) {
    return reinterpret_cast<Target*>(std::ranges::data(range));
  } else {
    return static_cast<Target*>(std::ranges::data(range));
  }
}

/// Returns how many numbers a range of numbers or of arrays of numbers holds.
template <class R>
std::size_t number_count(R&& range) noexcept {
  return static_cast<std::size_t>(std::ranges::size(range)) * RowOf<R>::width;
}

/// Throws InvalidArgument for an array of `count` numbers without data.
[[noreturn]] MESHORDER_API void refuse_null(std::size_t count);

/// Throws InvalidArgument if there are numbers and `data` is null.
constexpr void check_data(const void* data, std::size_t count) {
  if (data == nullptr && count > 0) refuse_null(count);
}

/// Returns a count as std::size_t; 0 for a negative count, so that later checks report a wrong size.
template <CountType N>
constexpr std::size_t checked_count(N count) noexcept {
  if constexpr (std::is_signed_v<N>) {
    if (count < 0) return 0;
  }
  return static_cast<std::size_t>(count);
}

}  // namespace detail
}  // namespace v0_3
}  // namespace meshorder
