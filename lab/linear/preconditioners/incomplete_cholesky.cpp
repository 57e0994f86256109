// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/preconditioners/incomplete_cholesky.hpp"

#include "base/parallel.hpp"
#include "kernels/owned_batches.hpp"
#include "lab/linear/preconditioners/symmetric_block.hpp"
#include "lab/linear/preconditioners/triangular_solve.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numbers>

namespace meshorder {
namespace {

/// Subtracts b · blockᵀ from a. All three are 3 × 3 matrices, stored row by row.
template <class Value>
void subtract_product(double* a, const double* b, const Value* block) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      a[3 * i + j] -=
          b[3 * i] * block[3 * j] + b[3 * i + 1] * block[3 * j + 1] + b[3 * i + 2] * block[3 * j + 2];
    }
  }
}

/// Returns whether each diagonal entry of a pivot exceeds a thousandth of the original entry.
bool is_large_enough(const double* pivot, const double* diagonal) {
  constexpr double kMin = 1e-3;
  for (int c = 0; c < 3; ++c) {
    if (!(pivot[4 * c] > kMin * diagonal[4 * c])) return false;
  }
  return true;
}

/// Returns for each vertex whether it has a neighbour in an earlier chunk.
std::vector<bool> joining_vertices(const BlockCsr& pattern, const std::vector<Index>& bounds) {
  std::vector<bool> joins(static_cast<std::size_t>(pattern.size()), false);
  for (Index chunk = 0; chunk + 1 < index_size(bounds); ++chunk) {
    for (Index v = bounds[chunk]; v < bounds[chunk + 1]; ++v) {
      // columns are ascending
      joins[v] =
          pattern.offsets[v] < pattern.offsets[v + 1] && pattern.columns[pattern.offsets[v]] < bounds[chunk];
    }
  }
  return joins;
}

}  // namespace

IncompleteCholesky::IncompleteCholesky(const BlockCsr& pattern)
    : Preconditioner(pattern.size()), offsets_{0} {
  const Index n = pattern.size();
  // chunks have enough rows for a thread's task and are few, so that few vertices join them; their number is
  // a power of two, so that usual numbers of threads share them evenly
  constexpr Index kRows = 8'000, kMaxChunks = 16;
  const auto count = static_cast<std::uint32_t>(std::clamp<Index>(n / kRows, 1, kMaxChunks));
  const std::vector<Index> chunks =
      balanced_ranges(pattern.offsets, static_cast<Index>(std::bit_floor(count)));
  const std::vector<bool> joins = joining_vertices(pattern, chunks);
  for (Index chunk = 0; chunk + 1 < index_size(chunks); ++chunk) {
    bounds_.push_back(index_size(vertices_));
    for (Index v = chunks[chunk]; v < chunks[chunk + 1]; ++v) {
      if (!joins[v]) vertices_.push_back(v);
    }
  }
  bounds_.push_back(index_size(vertices_));
  for (Index v = 0; v < n; ++v) {
    if (joins[v]) vertices_.push_back(v);
  }
  rows_.resize(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) rows_[vertices_[i]] = i;
  for (const Index v : vertices_) {
    diagonals_.push_back(diagonal_block(pattern, v));
    // columns: first the inner vertices, then those that join chunks, each ascending
    for (const bool joining : {false, true}) {
      if (joining && !joins[v]) continue;
      for (Offset k = pattern.offsets[v]; k < pattern.offsets[v + 1]; ++k) {
        const Index u = pattern.columns[k];
        if (joins[u] != joining || (joining == joins[v] && u >= v)) continue;
        columns_.push_back(u);
        sources_.push_back(k);
      }
    }
    offsets_.push_back(static_cast<Offset>(columns_.size()));
  }
  values_.assign(9 * columns_.size() + 1, 0.0F);
  inverses_.assign(6 * static_cast<std::size_t>(n), 0.0);
}

template <class Work>
void IncompleteCholesky::for_each_inner_range(Work work) const {
  for_each_part(index_size(bounds_) - 1, [&](Index chunk) { work(bounds_[chunk], bounds_[chunk + 1]); });
}

void IncompleteCholesky::take(const BlockCsr& matrix) {
  // elastic solids need a shift of about an eighth
  constexpr double kFirst = 1.0 / 64.0, kFactor = std::numbers::sqrt2, kMax = 64.0;
  shift_ = 0.0;
  while (!factor(matrix, shift_)) {
    shift_ = std::max(kFirst, kFactor * shift_);
    // the matrix is probably not positive definite
    if (shift_ > kMax) return keep_diagonal(matrix);
  }
}

bool IncompleteCholesky::factor(const BlockCsr& matrix, double shift) {
  // set to false by a thread that finds a bad pivot; then all threads stop
  std::atomic<bool> definite = true;
  for_each_inner_range([&](Index begin, Index end) { factor_rows(matrix, shift, begin, end, definite); });
  factor_rows(matrix, shift, bounds_.back(), size(), definite);
  return definite;
}

void IncompleteCholesky::factor_rows(const BlockCsr& matrix, double shift, Index begin, Index end,
                                     std::atomic<bool>& definite) {
  if (begin == end) return;
  // for each vertex u, the position in row i of the block in column u; −1 if there is no such block
  std::vector<Index> places(vertices_.size(), -1);
  // row i of L D
  std::vector<double> row;
  for (Index i = begin; i < end && definite.load(std::memory_order_relaxed); ++i) {
    const Offset first = offsets_[i];
    const auto count = static_cast<Index>(offsets_[i + 1] - first);
    row.resize(Offset{9} * count);
    for (Index a = 0; a < count; ++a) {
      std::copy_n(matrix.values.begin() + 9 * sources_[first + a], 9, row.begin() + Offset{9} * a);
      places[columns_[first + a]] = a;
    }
    const double* const diagonal = matrix.values.data() + 9 * diagonals_[i];
    std::array<double, 9> pivot{};
    for (int k = 0; k < 9; ++k) pivot[k] = (1.0 + shift) * diagonal[k];
    for (Index a = 0; a < count; ++a) {
      const Index u = columns_[first + a];
      double* const block = row.data() + Offset{9} * a;
      for (Offset k = offsets_[rows_[u]]; k < offsets_[rows_[u] + 1]; ++k) {
        const Index place = places[columns_[k]];
        if (place >= 0) subtract_product(block, row.data() + Offset{9} * place, values_.data() + 9 * k);
      }
      std::array<double, 9> scaled{};
      for (int c = 0; c < 3; ++c) {
        meshorder::multiply(inverses_.data() + Offset{6} * u, block + 3 * c, scaled.data() + 3 * c);
      }
      subtract_product(pivot.data(), block, scaled.data());
      for (int k = 0; k < 9; ++k) values_[9 * (first + a) + k] = static_cast<float>(scaled[k]);
    }
    for (Index a = 0; a < count; ++a) places[columns_[first + a]] = -1;
    const auto inverse = inverse_of_definite(upper_triangle(pivot.data()));
    if (!inverse || !is_large_enough(pivot.data(), diagonal)) {
      definite = false;
      return;
    }
    std::copy(inverse->begin(), inverse->end(), inverses_.begin() + Offset{6} * vertices_[i]);
  }
}

void IncompleteCholesky::keep_diagonal(const BlockCsr& matrix) {
  std::fill(values_.begin(), values_.end(), 0.0F);
  for (Index i = 0; i < size(); ++i) {
    const SymmetricBlock inverse = definite_inverse(upper_triangle(matrix.values.data() + 9 * diagonals_[i]));
    std::copy(inverse.begin(), inverse.end(), inverses_.begin() + Offset{6} * vertices_[i]);
  }
}

void IncompleteCholesky::multiply(std::span<const double> r, std::span<double> z) const {
  const BlockFactor factor{vertices_.data(), offsets_.data(), columns_.data(), values_.data(),
                           inverses_.data()};
  for_each_inner_range([&](Index begin, Index end) { solve_lower(factor, r.data(), z.data(), begin, end); });
  solve_lower(factor, r.data(), z.data(), bounds_.back(), size());
  for_each_chunk(size(), 4096,
                 [&](Index, Index begin, Index end) { solve_diagonal(factor, z.data(), begin, end); });
  solve_upper(factor, z.data(), bounds_.back(), size());
  for_each_inner_range([&](Index begin, Index end) { solve_upper(factor, z.data(), begin, end); });
}

std::size_t IncompleteCholesky::bytes() const {
  return (bounds_.capacity() + vertices_.capacity() + rows_.capacity() + columns_.capacity()) *
             sizeof(Index) +
         (offsets_.capacity() + sources_.capacity() + diagonals_.capacity()) * sizeof(Offset) +
         values_.capacity() * sizeof(float) + inverses_.capacity() * sizeof(double);
}

}  // namespace meshorder
