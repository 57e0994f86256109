// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/contact/solve/coloured_rows.hpp"

#include "base/error.hpp"
#include "kernels/positions.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/contact/solve/coloured_rows.cpp"
#include <hwy/foreach_target.h>
// from here on once for each instruction set
#include <hwy/highway.h>

#ifndef MESHORDER_COLOURED_ROWS_ONCE
#define MESHORDER_COLOURED_ROWS_ONCE
namespace meshorder {
namespace {

/// What the kernels need of ColouredRows.
template <class Real>
struct RowArrays {
  const Index* vertices;
  const Offset* offsets;
  const Index* columns;
  const Real* values;
  const Real* diagonal;
};

}  // namespace
}  // namespace meshorder
#endif

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
double relax_rows(const RowArrays<Real>& rows, Index begin, Index end, Real relaxation, const Real* b,
                  Real* x) {
  const hn::CappedTag<Real, kPaddedStride> d;
  using Value = hn::Vec<decltype(d)>;
  constexpr int kLanes = static_cast<int>(MaxLanes(d));
  constexpr int kParts = kPaddedStride / kLanes;
  Value squares = hn::Zero(d);
  for (Index row = begin; row < end; ++row) {
    const Offset at = Offset{kPaddedStride} * rows.vertices[row];
    Value sums[kParts];
    for (int i = 0; i < kParts; ++i) sums[i] = hn::Load(d, b + at + i * kLanes);
    for (Offset k = rows.offsets[row]; k < rows.offsets[row + 1]; ++k) {
      const Value value = hn::Set(d, rows.values[k]);
      const Real* const other = x + Offset{kPaddedStride} * rows.columns[k];
      for (int i = 0; i < kParts; ++i)
        sums[i] = hn::NegMulAdd(value, hn::Load(d, other + i * kLanes), sums[i]);
    }
    const Value factor = hn::Set(d, relaxation / rows.diagonal[row]);
    const Value diagonal = hn::Set(d, rows.diagonal[row]);
    for (int i = 0; i < kParts; ++i) {
      Real* const to = x + at + i * kLanes;
      const Value change = hn::Mul(factor, sums[i]);
      hn::Store(hn::Add(hn::Load(d, to), change), d, to);
      squares = hn::MulAdd(hn::Mul(change, change), diagonal, squares);
    }
  }
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, squares)));
}

double relax_doubles(const RowArrays<double>& rows, Index begin, Index end, double relaxation,
                     const double* b, double* x) {
  return relax_rows(rows, begin, end, relaxation, b, x);
}

double relax_floats(const RowArrays<float>& rows, Index begin, Index end, float relaxation, const float* b,
                    float* x) {
  return relax_rows(rows, begin, end, relaxation, b, x);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshorder {
namespace {

HWY_EXPORT(relax_doubles);
HWY_EXPORT(relax_floats);

/// The least colour that no neighbour before it has, for each vertex in turn.
std::vector<Index> first_fit_colours(const SparseMatrix& matrix) {
  std::vector<Index> colours(matrix.size(), -1);
  std::vector<Index> seen_by;  // the last vertex with a neighbour of the colour
  for (Index v = 0; v < matrix.size(); ++v) {
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
      const Index colour = colours[matrix.columns[k]];
      if (colour >= 0) seen_by[colour] = v;
    }
    Index colour = 0;
    while (colour < index_size(seen_by) && seen_by[colour] == v) ++colour;
    if (colour == index_size(seen_by)) seen_by.push_back(-1);
    colours[v] = colour;
  }
  return colours;
}

}  // namespace

template <class Real>
ColouredRows<Real>::ColouredRows(const SparseMatrix& matrix)
    : vertices_(matrix.size()), places_(matrix.size()), diagonal_(matrix.size()) {
  const std::vector<Index> colour_of = first_fit_colours(matrix);
  std::iota(vertices_.begin(), vertices_.end(), 0);
  std::stable_sort(vertices_.begin(), vertices_.end(),
                   [&](Index a, Index b) { return colour_of[a] < colour_of[b]; });
  columns_.reserve(matrix.columns.size());
  values_.reserve(matrix.values.size());
  for (Index place = 0; place < size(); ++place) {
    const Index v = vertices_[place];
    places_[v] = place;
    if (colour_of[v] == index_size(colours_)) colours_.push_back(place);
    for (Offset k = matrix.offsets[v]; k < matrix.offsets[v + 1]; ++k) {
      if (matrix.columns[k] == v) diagonal_[place] = static_cast<Real>(matrix.values[k]);
      columns_.push_back(matrix.columns[k]);
      values_.push_back(static_cast<Real>(matrix.values[k]));
    }
    if (!(diagonal_[place] > 0)) {
      throw InvalidArgument("ColouredRows: the diagonal of row " + std::to_string(v) +
                            " of the matrix must be positive");
    }
    offsets_.push_back(static_cast<Offset>(columns_.size()));
  }
  colours_.push_back(size());
  for (std::size_t colour = 0; colour + 1 < colours_.size(); ++colour) {
    const auto first = vertices_.begin() + colours_[colour];
    const auto last = vertices_.begin() + colours_[colour + 1];
    for (Index part = 0; part <= kParts; ++part) {
      const auto vertex = static_cast<Index>(Offset{size()} * part / kParts);
      parts_.push_back(static_cast<Index>(std::lower_bound(first, last, vertex) - vertices_.begin()));
    }
  }
}

template <class Real>
double ColouredRows<Real>::relax(Index begin, Index end, Real relaxation, std::span<const Real> b,
                                 std::span<Real> x) const {
  const RowArrays<Real> rows{vertices_.data(), offsets_.data(), columns_.data(), values_.data(),
                             diagonal_.data()};
  if constexpr (std::is_same_v<Real, double>) {
    return HWY_DYNAMIC_DISPATCH(relax_doubles)(rows, begin, end, relaxation, b.data(), x.data());
  } else {
    return HWY_DYNAMIC_DISPATCH(relax_floats)(rows, begin, end, relaxation, b.data(), x.data());
  }
}

template <class Real>
Point ColouredRows<Real>::residual(Index vertex, std::span<const Real> b, std::span<const Real> x) const {
  Point sum{};
  for (std::size_t c = 0; c < 3; ++c) {
    sum[c] = static_cast<double>(b[Offset{kPaddedStride} * vertex + static_cast<Index>(c)]);
  }
  const Index place = places_[vertex];
  for (Offset k = offsets_[place]; k < offsets_[place + 1]; ++k) {
    const Real* const p = x.data() + Offset{kPaddedStride} * columns_[k];
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] -= static_cast<double>(values_[k]) * static_cast<double>(p[c]);
    }
  }
  return sum;
}

template <class Real>
std::size_t ColouredRows<Real>::bytes() const {
  return (vertices_.size() + places_.size() + columns_.size() + parts_.size()) * sizeof(Index) +
         offsets_.size() * sizeof(Offset) + (values_.size() + diagonal_.size()) * sizeof(Real);
}

template class ColouredRows<double>;
template class ColouredRows<float>;

}  // namespace meshorder
#endif
