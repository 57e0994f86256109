// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/number_view.hpp>

#include <cstdint>
#include <span>

namespace meshorder {

/// Calls `work` with the numbers of a view as a span of their own type and returns its result, which has the
/// same type for all four.
template <class Work>
decltype(auto) with_type(const IndexView& numbers, const Work& work) {
  const auto as = [&]<class T>(T) {
    return std::span(static_cast<const T*>(numbers.data()), numbers.size());
  };
  if (numbers.bytes() == 4) return numbers.is_signed() ? work(as(std::int32_t{})) : work(as(std::uint32_t{}));
  return numbers.is_signed() ? work(as(std::int64_t{})) : work(as(std::uint64_t{}));
}

/// The same for numbers that `work` changes.
template <class Work>
decltype(auto) with_type(const IndexSpan& numbers, const Work& work) {
  const auto as = [&]<class T>(T) { return std::span(static_cast<T*>(numbers.data()), numbers.size()); };
  if (numbers.bytes() == 4) return numbers.is_signed() ? work(as(std::int32_t{})) : work(as(std::uint32_t{}));
  return numbers.is_signed() ? work(as(std::int64_t{})) : work(as(std::uint64_t{}));
}

/// The same for real numbers.
template <class Work>
decltype(auto) with_type(const RealView& numbers, const Work& work) {
  if (numbers.bytes() == 4) return work(std::span(static_cast<const float*>(numbers.data()), numbers.size()));
  return work(std::span(static_cast<const double*>(numbers.data()), numbers.size()));
}

}  // namespace meshorder
