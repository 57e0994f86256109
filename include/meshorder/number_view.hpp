// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/detail/ranges.hpp>
#include <meshorder/export.hpp>

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <type_traits>

namespace meshorder {
inline namespace v0_3 {

/// Type that meshorder uses to number vertices, cells and rows of matrices: at most 2,147,483,647 of each.
using Index = std::int32_t;

/// Position in an array with several entries for each vertex or cell; also a distance in bytes.
using Offset = std::int64_t;

/// A read-only view of the caller's integers: signed or unsigned, of 32 or 64 bits.
///
/// Converts implicitly from contiguous ranges of such integers (std::vector, std::span, std::array, C arrays)
/// and from contiguous ranges of std::array of such integers, which the view flattens: 10 tetrahedra as
/// `std::vector<std::array<int, 4>>` are 40 numbers. bool, character types and other sizes do not compile.
///
/// @note Nothing is copied: the array must live, at the same address, as long as the view is used. Functions
///       of meshorder use views only until they return. The view stores the type at run time: each function
///       is compiled once for all types.
class IndexView {
 public:
  /// A view of no numbers.
  constexpr IndexView() noexcept = default;

  /// @param data   `count` integers; may be null if there are none
  /// @param count  number of integers; a negative one counts as 0
  /// @throws InvalidArgument if there are integers and `data` is null
  template <IndexType T, CountType N>
  constexpr IndexView(const T* data MESHORDER_LIFETIMEBOUND, N count)
      : data_(data), size_(detail::checked_count(count)), bytes_(sizeof(T)), is_signed_(std::is_signed_v<T>) {
    detail::check_data(data_, size_);
  }

  /// A view of a container's integers.
  template <class R>
  requires(detail::IndexRange<const R&> && !detail::Borrowed<R>)
      IndexView(const R& numbers MESHORDER_LIFETIMEBOUND)  // NOLINT(google-explicit-constructor)
      : IndexView(detail::first_number(numbers), detail::number_count(numbers)) {}

  /// A view of the integers that a span or another view refers to.
  template <class R>
  requires(detail::IndexRange<const R&>&& detail::Borrowed<R>)
      IndexView(const R& numbers)  // NOLINT(google-explicit-constructor)
      : IndexView(detail::first_number(numbers), detail::number_count(numbers)) {}

  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] constexpr const void* data() const noexcept { return data_; }
  /// Returns the size of one integer: 4 or 8.
  [[nodiscard]] constexpr int bytes() const noexcept { return bytes_; }
  [[nodiscard]] constexpr bool is_signed() const noexcept { return is_signed_; }

  /// Returns integer `k` < size(). Unsigned integers from 2⁶³ on become negative. O(1), with a branch in each
  /// call: inner loops should read the array by its type.
  [[nodiscard]] std::int64_t operator[](std::size_t k) const noexcept {
    if (bytes_ == 4) {
      return is_signed_ ? std::int64_t{static_cast<const std::int32_t*>(data_)[k]}
                        : std::int64_t{static_cast<const std::uint32_t*>(data_)[k]};
    }
    return static_cast<const std::int64_t*>(data_)[k];
  }

 private:
  friend class IndexSpan;
  constexpr IndexView(const void* data, std::size_t size, int bytes, bool is_signed) noexcept
      : data_(data), size_(size), bytes_(bytes), is_signed_(is_signed) {}

  const void* data_ = nullptr;
  std::size_t size_ = 0;
  int bytes_ = sizeof(Index);
  bool is_signed_ = true;
};

/// A view of the caller's integers that a function writes to: a mutable `IndexView`.
///
/// Converts implicitly from the same ranges if they are not const: from lvalues of containers and from
/// spans.
class IndexSpan {
 public:
  /// A view of no numbers.
  constexpr IndexSpan() noexcept = default;

  /// @param data   `count` integers; may be null if there are none
  /// @param count  number of integers; a negative one counts as 0
  /// @throws InvalidArgument if there are integers and `data` is null
  template <IndexType T, CountType N>
  constexpr IndexSpan(T* data MESHORDER_LIFETIMEBOUND, N count)
      : data_(data), size_(detail::checked_count(count)), bytes_(sizeof(T)), is_signed_(std::is_signed_v<T>) {
    detail::check_data(data_, size_);
  }

  /// A view of a container's or a span's integers.
  template <class R>
  requires(detail::IndexRange<R>&& detail::Writable<R>)
      // NOLINTNEXTLINE(bugprone-forwarding-reference-overload,google-explicit-constructor)
      IndexSpan(R&& numbers)
      : IndexSpan(detail::first_number(numbers), detail::number_count(numbers)) {}

  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] constexpr void* data() const noexcept { return data_; }
  /// Returns the size of one integer: 4 or 8.
  [[nodiscard]] constexpr int bytes() const noexcept { return bytes_; }
  [[nodiscard]] constexpr bool is_signed() const noexcept { return is_signed_; }

  /// Returns a read-only view of the same integers.
  constexpr operator IndexView() const noexcept {  // NOLINT(google-explicit-constructor)
    return {data_, size_, bytes_, is_signed_};
  }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
  int bytes_ = sizeof(Index);
  bool is_signed_ = true;
};

/// A read-only view of the caller's real numbers, float or double. Converts implicitly from contiguous ranges
/// of such numbers. Lifetime: see `IndexView`.
class RealView {
 public:
  /// A view of no numbers.
  constexpr RealView() noexcept = default;

  /// @param data   `count` numbers; may be null if there are none
  /// @param count  number of numbers; a negative one counts as 0
  /// @throws InvalidArgument if there are numbers and `data` is null
  template <RealType T, CountType N>
  constexpr RealView(const T* data MESHORDER_LIFETIMEBOUND, N count)
      : data_(data), size_(detail::checked_count(count)), bytes_(sizeof(T)) {
    detail::check_data(data_, size_);
  }

  /// A view of a container's numbers.
  template <class R>
  requires(detail::RealRange<const R&> && !detail::Borrowed<R>)
      RealView(const R& numbers MESHORDER_LIFETIMEBOUND)  // NOLINT(google-explicit-constructor)
      : RealView(std::ranges::data(numbers), std::ranges::size(numbers)) {}

  /// A view of the numbers that a span or another view refers to.
  template <class R>
  requires(detail::RealRange<const R&>&& detail::Borrowed<R>)
      RealView(const R& numbers)  // NOLINT(google-explicit-constructor)
      : RealView(std::ranges::data(numbers), std::ranges::size(numbers)) {}

  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] constexpr const void* data() const noexcept { return data_; }
  /// Returns the size of one number: 4 or 8.
  [[nodiscard]] constexpr int bytes() const noexcept { return bytes_; }

  /// Returns number `k` < size(). O(1); a branch for each call.
  [[nodiscard]] double operator[](std::size_t k) const noexcept {
    return bytes_ == 4 ? double{static_cast<const float*>(data_)[k]} : static_cast<const double*>(data_)[k];
  }

 private:
  const void* data_ = nullptr;
  std::size_t size_ = 0;
  int bytes_ = sizeof(double);
};

}  // namespace v0_3
}  // namespace meshorder
