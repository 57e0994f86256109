// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/number_view.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/view.hpp>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace meshorder::python {

namespace nb = nanobind;

/// The caller's array, of any type and rank, row after row in the memory of the CPU. The Python half of the
/// module converts all other arrays to this form (meshorder/_arrays.py).
using Array = nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu>;
using MutableArray = nb::ndarray<nb::c_contig, nb::device::cpu>;

/// A one-dimensional array that Python owns and may not change.
template <class T>
using Result = nb::ndarray<nb::numpy, const T, nb::ndim<1>>;

/// Returns a view of integers of 32 or 64 bits, of any rank. Throws InvalidArgument for other types.
IndexView index_view(const Array& array);
IndexSpan index_span(const MutableArray& array);
/// Returns a view of float or double numbers. Throws InvalidArgument for other types.
RealView real_view(const Array& array);
/// Returns a view of points: rows of one to three coordinates, float or double. Throws likewise.
PointsView points_view(const nb::ndarray<nb::ro, nb::device::cpu>& array);

/// Moves a vector to an array that Python owns, without a copy.
template <class T>
Result<T> given(std::vector<T> values) {
  auto* const kept = new std::vector<T>(std::move(values));
  nb::capsule owner(kept, [](void* vector) noexcept { delete static_cast<std::vector<T>*>(vector); });
  return Result<T>(kept->data(), {kept->size()}, owner);
}

}  // namespace meshorder::python
