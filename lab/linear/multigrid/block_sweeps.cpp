// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/block_sweeps.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lab/linear/multigrid/block_sweeps.cpp"
#include <hwy/foreach_target.h>
// from here on compiled once for each instruction set
#include "lab/linear/multigrid/block_sweeps-inl.hpp"

#ifndef MESHORDER_SWEPT_ROWS
#define MESHORDER_SWEPT_ROWS
namespace meshorder {

/// Some rows of L and the vectors of a sweep over them.
struct SweptRows {
  const Offset* offsets;
  const Index* columns;
  const float* values;
  const float* inverse_diagonal;
  Index begin;
  Index end;
  const float* b;
  float* x;
  float* from_below;
  float* from_above;
};

}  // namespace meshorder
#endif

HWY_BEFORE_NAMESPACE();
namespace meshorder::HWY_NAMESPACE {
namespace {

constexpr int kBytesAhead = 2048;

/// Adds the contributions of row `i` to earlier rows. Contributions from the chunks above and below go to
/// separate memory, since two threads may add them at once.
template <int R>
HWY_INLINE void give(const SweptRows& rows, Index i, const Node<R>& x) {
  for (Offset k = rows.offsets[i]; k < rows.offsets[i + 1]; ++k) {
    const Index j = rows.columns[k];
    float* const to = j < rows.begin ? rows.from_above : rows.from_below;
    add_transposed_product<R, R>(rows.values + R * R * k, x, to + Offset{Node<R>::kStride} * j);
  }
}

/// Sets x = D⁻¹ · sum in row i; returns row i of x.
template <int R>
HWY_INLINE Node<R> solve_diagonal(const SweptRows& rows, Index i, const Node<R>& sum) {
  float entries[Node<R>::kStride];
  sum.store(entries);
  auto product = ProductSum<R, R>::zero();
  product.add(rows.inverse_diagonal + Offset{R * R} * i, entries);
  const Node<R> x = product.total().clean();
  x.store(rows.x + Offset{Node<R>::kStride} * i);
  return x;
}

/// Returns row i of L x. Prefetches blocks `Ahead` bytes further on; `Ahead` is negative in descending
/// sweeps, for which hardware does not prefetch.
template <int R, int Ahead>
HWY_INLINE Node<R> left_product(const SweptRows& rows, Index i) {
  auto product = ProductSum<R, R>::zero();
  for (Offset k = rows.offsets[i]; k < rows.offsets[i + 1]; ++k) {
    MESHORDER_UNROLL
    for (int line = 0; line < 4 * R * R; line += 64) {
      __builtin_prefetch(reinterpret_cast<const char*>(rows.values + R * R * k) + Ahead + line);
    }
    product.add(rows.values + R * R * k, rows.x + Offset{Node<R>::kStride} * rows.columns[k]);
  }
  return product.total();
}

template <int R>
HWY_INLINE void forwards(const SweptRows& rows) {
  for (Index i = rows.begin; i < rows.end; ++i) {
    const Node<R> b = Node<R>::load(rows.b + Offset{Node<R>::kStride} * i);
    give<R>(rows, i, solve_diagonal<R>(rows, i, b - left_product<R, kBytesAhead>(rows, i)));
  }
}

template <int R>
HWY_INLINE void backwards(const SweptRows& rows) {
  for (Index i = rows.end - 1; i >= rows.begin; --i) {
    const Offset place = Offset{Node<R>::kStride} * i;
    const Node<R> left = left_product<R, -kBytesAhead>(rows, i);
    const Node<R> given = Node<R>::load(rows.from_below + place) + Node<R>::load(rows.from_above + place);
    const Node<R> b = Node<R>::load(rows.b + place) - given;
    give<R>(rows, i, solve_diagonal<R>(rows, i, b - left));
  }
}

template <int R>
HWY_INLINE void residual_after_backwards(const SweptRows& rows, const float* before, float* residual) {
  for (Index i = rows.begin; i < rows.end; ++i) {
    auto product = ProductSum<R, R>::zero();
    for (Offset k = rows.offsets[i]; k < rows.offsets[i + 1]; ++k) {
      const Offset place = Offset{Node<R>::kStride} * rows.columns[k];
      float change[Node<R>::kStride];
      (Node<R>::load(before + place) - Node<R>::load(rows.b + place)).store(change);
      product.add(rows.values + R * R * k, change);
    }
    product.total().clean().store(residual + Offset{Node<R>::kStride} * i);
  }
}

void forwards_3(const SweptRows& rows) { forwards<3>(rows); }
void forwards_6(const SweptRows& rows) { forwards<6>(rows); }
void backwards_3(const SweptRows& rows) { backwards<3>(rows); }
void backwards_6(const SweptRows& rows) { backwards<6>(rows); }
void residual_3(const SweptRows& rows, const float* before, float* residual) {
  residual_after_backwards<3>(rows, before, residual);
}
void residual_6(const SweptRows& rows, const float* before, float* residual) {
  residual_after_backwards<6>(rows, before, residual);
}

}  // namespace
}  // namespace meshorder::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "kernels/simd_dispatch.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace meshorder {
namespace {

MESHORDER_SIMD_VERSIONS(forwards_3);
MESHORDER_SIMD_VERSIONS(forwards_6);
MESHORDER_SIMD_VERSIONS(backwards_3);
MESHORDER_SIMD_VERSIONS(backwards_6);
MESHORDER_SIMD_VERSIONS(residual_3);
MESHORDER_SIMD_VERSIONS(residual_6);

/// Returns whether all neighbours of every row are in the row's own chunk or an adjacent chunk.
bool touch_only_the_next(const Laplacian& graph, const RowChunks& chunks) {
  bool result = true;
  for (Index i = 0; i < graph.size(); ++i) {
    for (Offset k = graph.offsets[i]; k < graph.offsets[i + 1]; ++k) {
      result = result && std::abs(chunks.chunk_of(graph.neighbours[k]) - chunks.chunk_of(i)) <= 1;
    }
  }
  return result;
}

/// Returns the smallest chunks of at least `min_rows` rows with edges only to adjacent chunks; or one chunk.
RowChunks sweep_chunks(const Laplacian& graph, Index min_rows) {
  for (Index rows = min_rows; rows < graph.size(); rows *= 2) {
    RowChunks chunks(graph, rows);
    if (chunks.count() > 1 && touch_only_the_next(graph, chunks)) return chunks;
  }
  return RowChunks::whole(graph.size());
}

/// Returns the inverse of a symmetric block after making its eigenvalues positive; the identity if the block
/// is 0; 0 if the block is not finite.
template <int R>
Eigen::Matrix<double, R, R> positive_inverse(const Eigen::Matrix<double, R, R>& block) {
  using Block = Eigen::Matrix<double, R, R>;
  constexpr double kMin = 1e-9;  // smallest eigenvalue, as a share of the largest
  const Eigen::LLT<Block> factor(block);
  if (factor.info() == Eigen::Success) {
    const auto pivots = factor.matrixLLT().diagonal();
    if (std::pow(pivots.minCoeff() / pivots.maxCoeff(), 2) > kMin) return factor.solve(Block::Identity());
  }
  if (!block.allFinite()) return Block::Zero();
  const Eigen::SelfAdjointEigenSolver<Block> solver(block);
  Eigen::Matrix<double, R, 1> values = solver.eigenvalues().cwiseAbs();
  const double largest = values.maxCoeff();
  if (!(largest > 0)) return Block::Identity();
  values = values.cwiseMax(kMin * largest).cwiseInverse();
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

template <int R>
BlockSweeps<R>::BlockSweeps(const BlockView<R>& pattern, Index min_rows) {
  const Index n = pattern.rows();
  Laplacian graph;
  graph.offsets.reserve(Offset{n} + 1);
  for (Index i = 0; i < n; ++i) {
    pattern.for_each_in_row(i, [&](Index j, const double*) {
      if (j != i) graph.neighbours.push_back(j);
    });
    graph.offsets.push_back(static_cast<Offset>(graph.neighbours.size()));
  }
  graph.diagonal.assign(n, 1.0);
  chunks_ = sweep_chunks(graph, min_rows);
  std::vector<Index> colour_of(std::max(chunks_.count(), 1));
  for (Index colour = 0; colour < index_size(chunks_.colours()); ++colour) {
    for (const Index chunk : chunks_.colours()[colour]) colour_of[chunk] = colour;
  }
  const auto is_before = [&](Index j, Index i) {
    const Index colour_of_j = colour_of[chunks_.chunk_of(j)];
    const Index colour_of_i = colour_of[chunks_.chunk_of(i)];
    return colour_of_j == colour_of_i ? j < i : colour_of_j < colour_of_i;
  };

  offsets_.reserve(Offset{n} + 1);
  std::vector<std::pair<Index, Index>> left;  // a column's number in the view, and in the matrix
  for (Index i = 0; i < n; ++i) {
    left.clear();
    const Index row = pattern.order[i];
    for (Offset k = pattern.offsets[row]; k < pattern.offsets[row + 1]; ++k) {
      const Index j = pattern.number[pattern.columns[k]];
      if (j != i && is_before(j, i)) left.emplace_back(j, pattern.columns[k]);
    }
    std::sort(left.begin(), left.end());
    for (const auto& [j, column] : left) {
      columns_.push_back(j);
      // block (j, i) row by row is block (i, j) column by column
      const auto begin = pattern.columns.begin() + pattern.offsets[column];
      const auto end = pattern.columns.begin() + pattern.offsets[column + 1];
      sources_.push_back(static_cast<Index>(std::lower_bound(begin, end, row) - pattern.columns.begin()));
    }
    offsets_.push_back(static_cast<Offset>(columns_.size()));
  }
  values_.assign(R * R * columns_.size() + kNodeStride<R>, 0.0F);
  inverse_diagonal_.assign(std::size_t{R} * R * n + kNodeStride<R>, 0.0F);
}

template <int R>
void BlockSweeps<R>::update(const BlockView<R>& matrix) {
  constexpr Index kRows = 1024;
  for_each_chunk(rows(), kRows, [&](Index, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      for (Offset k = offsets_[i]; k < offsets_[i + 1]; ++k) {
        const double* const source = matrix.values.data() + Offset{R * R} * sources_[k];
        std::transform(source, source + R * R, values_.begin() + R * R * k,
                       [](double value) { return static_cast<float>(value); });
      }
      Eigen::Matrix<double, R, R> diagonal = Eigen::Matrix<double, R, R>::Zero();
      matrix.for_each_in_row(i, [&](Index j, const double* block) {
        if (j == i) diagonal = Eigen::Map<const Eigen::Matrix<double, R, R>>(block);
      });
      Eigen::Map<Eigen::Matrix<float, R, R>>(inverse_diagonal_.data() + Offset{R * R} * i) =
          positive_inverse<R>(diagonal).template cast<float>();
    }
  });
}

template <int R>
void BlockSweeps<R>::clear(Given& given) const {
  chunks_.for_each([&](Index, Index begin, Index end) {
    for (AlignedVector<float>* const given_to : {&given.from_below, &given.from_above})
      std::fill_n(given_to->begin() + Offset{kNodeStride<R>} * begin, kNodeStride<R> * (end - begin), 0.0F);
  });
}

template <int R>
SweptRows BlockSweeps<R>::rows_swept(Index begin, Index end, const float* b, float* x, Given* given) const {
  return {offsets_.data(),
          columns_.data(),
          values_.data(),
          inverse_diagonal_.data(),
          begin,
          end,
          b,
          x,
          given == nullptr ? nullptr : given->from_below.data(),
          given == nullptr ? nullptr : given->from_above.data()};
}

template <int R>
void BlockSweeps<R>::forwards(const AlignedVector<float>& b, AlignedVector<float>& x,
                              AlignedVector<float>& residual, Given& given) const {
  clear(given);
  chunks_.for_each_forwards([&](Index begin, Index end) {
    const SweptRows swept = rows_swept(begin, end, b.data(), x.data(), &given);
    if constexpr (R == 3) MESHORDER_SIMD(forwards_3)(swept);
    if constexpr (R == 6) MESHORDER_SIMD(forwards_6)(swept);
  });
  chunks_.for_each([&](Index, Index begin, Index end) {
    const Offset first = Offset{kNodeStride<R>} * begin;
    const Offset last = Offset{kNodeStride<R>} * end;
    std::transform(given.from_below.begin() + first, given.from_below.begin() + last,
                   given.from_above.begin() + first, residual.begin() + first,
                   [](float below, float above) { return -(below + above); });
  });
}

template <int R>
void BlockSweeps<R>::backwards(const AlignedVector<float>& b, AlignedVector<float>& x, Given& given) const {
  clear(given);
  chunks_.for_each_backwards([&](Index begin, Index end) {
    const SweptRows swept = rows_swept(begin, end, b.data(), x.data(), &given);
    if constexpr (R == 3) MESHORDER_SIMD(backwards_3)(swept);
    if constexpr (R == 6) MESHORDER_SIMD(backwards_6)(swept);
  });
}

template <int R>
void BlockSweeps<R>::residual_after_backwards(const AlignedVector<float>& before,
                                              const AlignedVector<float>& x,
                                              AlignedVector<float>& residual) const {
  chunks_.for_each([&](Index, Index begin, Index end) {
    const SweptRows swept = rows_swept(begin, end, x.data(), nullptr, nullptr);
    if constexpr (R == 3) MESHORDER_SIMD(residual_3)(swept, before.data(), residual.data());
    if constexpr (R == 6) MESHORDER_SIMD(residual_6)(swept, before.data(), residual.data());
  });
}

template <int R>
std::size_t BlockSweeps<R>::bytes() const {
  return sizeof(Offset) * offsets_.capacity() + sizeof(Index) * (columns_.capacity() + sources_.capacity()) +
         sizeof(float) * (values_.capacity() + inverse_diagonal_.capacity());
}

template class BlockSweeps<3>;
template class BlockSweeps<6>;

}  // namespace meshorder
#endif
