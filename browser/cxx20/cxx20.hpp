// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Parts of C++20's standard library that the project uses, and that Debian 12's emscripten 3.1.6 lacks: its
// libc++ is that of LLVM 13. Included before each source. Newer libraries get nothing from here.
#pragma once

#include <version>

#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
#include <algorithm>
#include <array>
#include <charconv>
#include <compare>
#include <functional>
#include <memory>
#include <ranges>
#include <type_traits>
#include <utility>

// the library's own inline namespace within std
_LIBCPP_BEGIN_NAMESPACE_STD

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

/// An atomic_ref for one thread: plain reads and writes.
template <class T>
class atomic_ref {
 public:
  explicit atomic_ref(T& object) : object_(object) {}
  [[nodiscard]] T load(memory_order) const { return object_; }
  void store(T value, memory_order) const { object_ = value; }
  bool compare_exchange_weak(T& expected, T value, memory_order) const {
    if (object_ == expected) {
      object_ = value;
      return true;
    }
    expected = object_;
    return false;
  }

 private:
  T& object_;
};

template <class A, class B>
constexpr auto lexicographical_compare_three_way(A a, A a_end, B b, B b_end) {
  for (; a != a_end && b != b_end; ++a, ++b) {
    if (const auto order = *a <=> *b; order != 0) return order;
  }
  return (a != a_end) <=> (b != b_end);
}

template <class T, size_t size>
constexpr auto operator<=>(const array<T, size>& a, const array<T, size>& b) {
  return std::lexicographical_compare_three_way(a.begin(), a.end(), b.begin(), b.end());
}

// Convert between numbers and text with the results of GCC's library.
from_chars_result from_chars(const char* first, const char* last, double& value);
from_chars_result from_chars(const char* first, const char* last, float& value);
to_chars_result to_chars(char* first, char* last, double value);
to_chars_result to_chars(char* first, char* last, double value, chars_format format);
to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision);

namespace ranges {

/// Returns a function that compares two values after a projection.
template <class Compare, class Project>
auto compared(Compare& compare, Project& project) {
  return [&](auto&& a, auto&& b) { return invoke(compare, invoke(project, a), invoke(project, b)); };
}

template <class Range, class Call>
constexpr void for_each(Range&& range, Call call) {
  for (auto&& value : range) invoke(call, value);
}
template <class Range, class Test>
constexpr bool all_of(Range&& range, Test test) {
  return std::all_of(ranges::begin(range), ranges::end(range), std::ref(test));
}
template <class Range, class Test>
constexpr bool any_of(Range&& range, Test test) {
  return std::any_of(ranges::begin(range), ranges::end(range), std::ref(test));
}
template <class Range, class Test>
constexpr bool none_of(Range&& range, Test test) {
  return std::none_of(ranges::begin(range), ranges::end(range), std::ref(test));
}
template <class Range, class Value>
constexpr auto count(Range&& range, const Value& value) {
  return std::count(ranges::begin(range), ranges::end(range), value);
}
template <class Range, class Value>
constexpr auto find(Range&& range, const Value& value) {
  return std::find(ranges::begin(range), ranges::end(range), value);
}
template <class Range, class Test>
constexpr auto find_if(Range&& range, Test test) {
  return std::find_if(ranges::begin(range), ranges::end(range), std::ref(test));
}
template <class Range, class Out>
constexpr void copy(Range&& range, Out out) {
  std::copy(ranges::begin(range), ranges::end(range), out);
}
template <class Range, class Out, class Test>
constexpr void copy_if(Range&& range, Out out, Test test) {
  std::copy_if(ranges::begin(range), ranges::end(range), out, std::ref(test));
}
template <class Range, class Out, class Call>
constexpr void transform(Range&& range, Out out, Call call) {
  for (auto&& value : range) *out++ = invoke(call, value);
}
template <class Range>
constexpr void reverse(Range&& range) {
  std::reverse(ranges::begin(range), ranges::end(range));
}
template <class Range, class Compare = less, class Project = identity>
constexpr void sort(Range&& range, Compare compare = {}, Project project = {}) {
  std::sort(ranges::begin(range), ranges::end(range), compared(compare, project));
}
template <class Range, class Compare = less, class Project = identity>
constexpr void stable_sort(Range&& range, Compare compare = {}, Project project = {}) {
  std::stable_sort(ranges::begin(range), ranges::end(range), compared(compare, project));
}
template <class Range>
constexpr bool is_sorted(Range&& range) {
  return std::is_sorted(ranges::begin(range), ranges::end(range));
}
template <class Range, class Compare = less, class Project = identity>
constexpr auto min_element(Range&& range, Compare compare = {}, Project project = {}) {
  return std::min_element(ranges::begin(range), ranges::end(range), compared(compare, project));
}
template <class Range, class Compare = less, class Project = identity>
constexpr auto max_element(Range&& range, Compare compare = {}, Project project = {}) {
  return std::max_element(ranges::begin(range), ranges::end(range), compared(compare, project));
}
template <class Range, class Value>
constexpr auto lower_bound(Range&& range, const Value& value) {
  return std::lower_bound(ranges::begin(range), ranges::end(range), value);
}
template <class Range, class Value>
constexpr auto upper_bound(Range&& range, const Value& value) {
  return std::upper_bound(ranges::begin(range), ranges::end(range), value);
}
template <class A, class B, class Equal = equal_to, class OfA = identity, class OfB = identity>
constexpr bool equal(A&& a, B&& b, Equal equal = {}, OfA of_a = {}, OfB of_b = {}) {
  return std::equal(ranges::begin(a), ranges::end(a), ranges::begin(b), ranges::end(b),
                    [&](auto&& x, auto&& y) { return invoke(equal, invoke(of_a, x), invoke(of_b, y)); });
}
template <class A, class B>
constexpr bool lexicographical_compare(A&& a, B&& b) {
  return std::lexicographical_compare(ranges::begin(a), ranges::end(a), ranges::begin(b), ranges::end(b));
}

}  // namespace ranges

_LIBCPP_END_NAMESPACE_STD
#endif
