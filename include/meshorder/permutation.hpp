// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/detail/ranges.hpp>
#include <meshorder/export.hpp>
#include <meshorder/number_view.hpp>
#include <meshorder/options.hpp>
#include <meshorder/view.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// A bijection of 0 … n−1, stored in both directions. Moves arrays to the new order.
///
/// `old_to_new()[i]` is the new place of the item that was at place i. `new_to_old()[k]` is the old place of
/// the item that is now at place k. For SciPy, MATLAB and PETSc `new_to_old` is the index array: `moved =
/// array[new_to_old]`.
///
/// @note Immutable except for assignment, so several threads may read one object. Memory: 8 n bytes.
class MESHORDER_API Permutation {
 public:
  /// The empty permutation, n = 0.
  Permutation() = default;

  /// Returns the permutation that moves nothing.
  ///
  /// @param n  number of places, ≥ 0
  /// @throws InvalidArgument if n is negative
  static Permutation identity(Index n);

  /// Makes a permutation from a map of old to new places: `map[i]` is the new place of old item i.
  ///
  /// @throws InvalidArgument if the map is not a bijection of 0 … n−1; the message names the first faulty
  ///         entries
  /// @throws TooLarge for more than 2,147,483,647 entries
  /// @note O(n), on all threads.
  static Permutation from_old_to_new(IndexView map);
  static Permutation from_old_to_new(std::vector<Index>&& map);  ///< the same without a copy of the map
  static Permutation from_old_to_new(std::initializer_list<Index> map) {  ///< the same for a list in braces
    return from_old_to_new(std::vector<Index>(map));
  }

  /// Makes a permutation from a map of new to old places: `map[k]` is the old place of the item at new place
  /// k. The map thus lists the old items in their new order. Throws and costs as `from_old_to_new`.
  static Permutation from_new_to_old(IndexView map);
  static Permutation from_new_to_old(std::vector<Index>&& map);  ///< the same without a copy of the map
  static Permutation from_new_to_old(std::initializer_list<Index> map) {  ///< the same for a list in braces
    return from_new_to_old(std::vector<Index>(map));
  }

  /// Returns the number of places n.
  [[nodiscard]] Index size() const noexcept { return static_cast<Index>(old_to_new_.size()); }

  /// Returns the new place of each old item: n entries. Valid while this object is neither assigned to nor
  /// destroyed.
  [[nodiscard]] std::span<const Index> old_to_new() const& noexcept MESHORDER_LIFETIMEBOUND {
    return old_to_new_;
  }
  [[nodiscard]] std::vector<Index> old_to_new() && noexcept { return std::move(old_to_new_); }

  /// Returns the old place of the item at each new place: n entries. Valid while this object is neither
  /// assigned to nor destroyed.
  [[nodiscard]] std::span<const Index> new_to_old() const& noexcept MESHORDER_LIFETIMEBOUND {
    return new_to_old_;
  }
  [[nodiscard]] std::vector<Index> new_to_old() && noexcept { return std::move(new_to_old_); }

  /// Returns true if nothing moves. O(n).
  [[nodiscard]] bool is_identity() const noexcept;

  /// Returns the permutation that moves everything back. O(n); O(1) for an rvalue.
  [[nodiscard]] Permutation inverse() const&;
  [[nodiscard]] Permutation inverse() && noexcept;

  /// Returns this permutation followed by `next`: the result's old_to_new[i] is
  /// next.old_to_new[old_to_new[i]]. O(n).
  ///
  /// @throws InvalidArgument if the sizes differ
  [[nodiscard]] Permutation then(const Permutation& next) const;

  /// Returns the permutation of degrees of freedom, `components` for each place.
  ///
  /// @param components  ≥ 1
  /// @param node_major  true: component c of place i is number components · i + c; false: c · n + i
  /// @throws InvalidArgument if components < 1
  /// @throws TooLarge if components · n exceeds 2,147,483,647
  /// @note O(components · n).
  [[nodiscard]] Permutation repeated(Index components, bool node_major = true) const;

  /// Copies rows to their new places: row k of `to` becomes row new_to_old[k] of `from`.
  ///
  /// @param from   n · width values, row after row; any copyable type
  /// @param to     as many values of the same type; must not overlap `from`
  /// @param width  values in a row
  /// @throws InvalidArgument if a size is not n · width or the arrays overlap
  /// @note O(n · width). Trivially copyable types move as bytes on all threads, others one by one.
  template <std::ranges::contiguous_range From, std::ranges::contiguous_range To>
  requires std::same_as<std::ranges::range_value_t<From>, std::ranges::range_value_t<To>>
  void move(const From& from, To&& to, std::size_t width = 1) const;

  /// Moves the rows of an array to their new places within the array.
  ///
  /// @param values  n · width values, row after row
  /// @param width   values in a row
  /// @throws InvalidArgument if the size is not n · width
  /// @note O(n · width) on one thread. Rows of trivially copyable types move along the cycles of the
  ///       permutation, with n / 8 bytes and one row of extra memory; other types need a second array. `move`
  ///       is faster if memory suffices.
  template <std::ranges::contiguous_range R>
  void move_in_place(R&& values, std::size_t width = 1) const;

  /// Copies rows of bytes to their new places: row k of `to` becomes row new_to_old[k] of `from`.
  ///
  /// @param from         row i is at `from + i · from_stride` bytes
  /// @param from_stride  bytes from a row to the next; may be larger than the row, or negative
  /// @param to           row k is at `to + k · to_stride` bytes; rows must not overlap each other or those of
  ///                     `from`
  /// @param to_stride    the same for `to`
  /// @param row_bytes    bytes of a row
  /// @param run          threads; progress and time limit are not used
  /// @throws InvalidArgument for null arrays with n > 0 and row_bytes > 0, or if dense arrays overlap
  /// @note O(n · row_bytes).
  void move_rows(const void* from, Offset from_stride, void* to, Offset to_stride, std::size_t row_bytes,
                 const Run& run = {}) const;

  /// Replaces old numbers by new numbers, for example in a mesh's connectivity after its vertices have moved:
  /// number v becomes base + old_to_new[v − base].
  ///
  /// @param numbers  any count, each in base … base + n − 1; may be a range of std::array
  /// @param base     0 or 1
  /// @throws InvalidArgument for a number outside that range or another base; nothing is changed then
  /// @note O(numbers), two passes, on all threads.
  void renumber(IndexSpan numbers, int base = 0) const;

  /// Moves the rows and columns of a square sparse matrix: B = P A Pᵀ, B[old_to_new[i], old_to_new[j]] = A[i,
  /// j].
  ///
  /// Columns ascend in every row of B; entries of repeated columns keep their order. The pattern of A may be
  /// asymmetric and unsorted and may have a diagonal.
  ///
  /// @param matrix   A: n rows; its weights are ignored; B has the same base
  /// @param values   the same number of bytes for each entry of A, one after another; may be empty
  /// @param offsets  n + 1 offsets of B, written
  /// @param columns  columns of B's entries, as many as A has entries, written
  /// @param moved    as many bytes as `values`, written; no output may overlap another array
  /// @throws InvalidArgument if sizes do not match, A is faulty or an output overlaps another array
  /// @throws TooLarge if an output type cannot hold its numbers
  /// @note O(n + entries · log row), on all threads. Memory: 8 (n + 1) bytes and a row for each thread. If
  ///       the offsets are not int64, the columns not int32 or the base not 0: up to 8 (n + 1) bytes and 4
  ///       bytes an entry more.
  void move_csr(const GraphView& matrix, std::span<const std::byte> values, IndexSpan offsets,
                IndexSpan columns, std::span<std::byte> moved) const;

  /// Returns a map from the entries of B (see `move_csr`) to those of A, both counted from 0: entry k of B is
  /// entry map[k] of A. For matrices whose values change while the pattern stays. Throws and costs as
  /// `move_csr`; 8 bytes an entry.
  [[nodiscard]] std::vector<Offset> csr_entry_map(const GraphView& matrix) const;

  bool operator==(const Permutation&) const = default;

 private:
  Permutation(std::vector<Index> old_to_new, std::vector<Index> new_to_old) noexcept
      : old_to_new_(std::move(old_to_new)), new_to_old_(std::move(new_to_old)) {}
  void check_size(std::size_t values, std::size_t width) const;
  void move_bytes_in_place(void* rows, std::size_t row_bytes) const;
  static void check_apart(const void* from, const void* to, std::size_t bytes);

  std::vector<Index> old_to_new_;
  std::vector<Index> new_to_old_;
};

template <std::ranges::contiguous_range From, std::ranges::contiguous_range To>
requires std::same_as<std::ranges::range_value_t<From>, std::ranges::range_value_t<To>>
void Permutation::move(const From& from, To&& to, std::size_t width) const {
  using T = std::ranges::range_value_t<From>;
  static_assert(!std::is_const_v<std::remove_reference_t<std::ranges::range_reference_t<To>>>,
                "the values of `to` must not be const");
  static_assert(std::ranges::borrowed_range<To>,
                "`to` must outlive the call: a container by name, or a span");
  check_size(static_cast<std::size_t>(std::ranges::size(from)), width);
  check_size(static_cast<std::size_t>(std::ranges::size(to)), width);
  const T* const source = std::ranges::data(from);
  T* const target = std::ranges::data(to);
  check_apart(source, target, static_cast<std::size_t>(std::ranges::size(from)) * sizeof(T));
  if constexpr (std::is_trivially_copyable_v<T>) {
    const auto stride = static_cast<Offset>(width * sizeof(T));
    move_rows(source, stride, target, stride, width * sizeof(T));
  } else {
    for (std::size_t k = 0; k < new_to_old_.size(); ++k) {
      std::copy_n(source + static_cast<std::size_t>(new_to_old_[k]) * width, width, target + k * width);
    }
  }
}

template <std::ranges::contiguous_range R>
void Permutation::move_in_place(R&& values, std::size_t width) const {
  using T = std::ranges::range_value_t<R>;
  static_assert(!std::is_const_v<std::remove_reference_t<std::ranges::range_reference_t<R>>>,
                "the values must not be const");
  static_assert(std::ranges::borrowed_range<R>,
                "the array must outlive the call: a container by name, or a span");
  check_size(static_cast<std::size_t>(std::ranges::size(values)), width);
  T* const rows = std::ranges::data(values);
  if constexpr (std::is_trivially_copyable_v<T>) {
    move_bytes_in_place(rows, width * sizeof(T));
  } else {
    std::vector<T> moved;
    moved.reserve(new_to_old_.size() * width);
    for (const Index old : new_to_old_) {
      const auto row = rows + static_cast<std::size_t>(old) * width;
      std::copy_n(std::make_move_iterator(row), width, std::back_inserter(moved));
    }
    std::move(moved.begin(), moved.end(), rows);
  }
}

}  // namespace v0_3
}  // namespace meshorder
