// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "arrays.hpp"

#include <meshorder/error.hpp>

namespace meshorder::python {
namespace {

using Code = nb::dlpack::dtype_code;

template <class Number>
bool holds(const nb::dlpack::dtype& type) {
  return type == nb::dtype<Number>();
}

/// Returns a view of the array's numbers. Throws InvalidArgument unless their type is in `Numbers`.
template <class View, class... Numbers, class Data>
View viewed(const nb::dlpack::dtype& type, Data* data, std::size_t size, const char* wanted) {
  View view;
  const auto try_type = [&]<class Number>(Number) {
    using Element = std::conditional_t<std::is_const_v<Data>, const Number, Number>;
    if (!holds<Number>(type)) return false;
    view = View(static_cast<Element*>(data), size);
    return true;
  };
  if (!(try_type(Numbers{}) || ...)) throw InvalidArgument(std::string("expected an array of ") + wanted);
  return view;
}

constexpr const char* kIntegers = "integers of 32 or 64 bits";

}  // namespace

IndexView index_view(const Array& array) {
  return viewed<IndexView, std::int32_t, std::int64_t, std::uint32_t, std::uint64_t>(
      array.dtype(), array.data(), array.size(), kIntegers);
}

IndexSpan index_span(const MutableArray& array) {
  return viewed<IndexSpan, std::int32_t, std::int64_t, std::uint32_t, std::uint64_t>(
      array.dtype(), array.data(), array.size(), kIntegers);
}

RealView real_view(const Array& array) {
  return viewed<RealView, double, float>(array.dtype(), array.data(), array.size(), "float32 or float64");
}

PointsView points_view(const nb::ndarray<nb::ro, nb::device::cpu>& array) {
  if (array.ndim() != 2) throw InvalidArgument("points: expected one row of 1 to 3 coordinates for each");
  const auto bytes = static_cast<Offset>(array.itemsize());
  const auto view = [&]<class Number>(Number) {
    return PointsView(static_cast<const Number*>(array.data()), array.shape(0),
                      static_cast<int>(std::min<std::size_t>(array.shape(1), 4)), array.stride(0) * bytes,
                      array.stride(1) * bytes);
  };
  if (holds<double>(array.dtype())) return view(double{});
  if (holds<float>(array.dtype())) return view(float{});
  throw InvalidArgument("points: expected float32 or float64");
}

}  // namespace meshorder::python
