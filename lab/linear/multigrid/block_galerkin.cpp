// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/block_galerkin.hpp"

#include "base/parallel.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <numeric>

namespace meshorder {
namespace {

template <int R, int C>
using Block = Eigen::Matrix<double, R, C, Eigen::RowMajor>;
template <int R, int C>
using FloatBlock = Eigen::Matrix<float, R, C, Eigen::RowMajor>;

/// Calls `work(begin, end)` for shares of the rows. The shares are so few that each may allocate a number for
/// every row of the matrix.
template <class Work>
void for_each_share(Index rows, Work work) {
  constexpr Index kShares = 16;
  constexpr Index kMinRows = 64;
  for_each_chunk(rows, std::max(kMinRows, chunk_count(rows, kShares)),
                 [&](Index, Index begin, Index end) { work(begin, end); });
}

/// The set of columns that a row has met. Reused for row after row.
class ColumnSet {
 public:
  explicit ColumnSet(Index columns) : place_(columns, -1) {}

  /// Returns the position of the column in the sequence of columns met; appends the column if it is new.
  Index place(Index column) {
    if (place_[column] < 0) {
      place_[column] = index_size(columns_);
      columns_.push_back(column);
    }
    return place_[column];
  }
  [[nodiscard]] std::vector<Index>& columns() noexcept { return columns_; }
  void clear() {
    for (const Index column : columns_) place_[column] = -1;
    columns_.clear();
  }

 private:
  std::vector<Index> place_;
  std::vector<Index> columns_;
};

/// The columns of each row, found share by share, to be joined into one pattern.
class PatternParts {
 public:
  explicit PatternParts(Index rows) : rows_(rows) {}
  std::vector<Index>& row(Index i) { return rows_[i]; }

  template <class Matrix>
  void put_into(Matrix& matrix) const {
    matrix.offsets.assign(rows_.size() + 1, 0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      matrix.offsets[i + 1] = matrix.offsets[i] + static_cast<Offset>(rows_[i].size());
    }
    matrix.columns.reserve(matrix.offsets.back());
    for (const std::vector<Index>& row : rows_) {
      matrix.columns.insert(matrix.columns.end(), row.begin(), row.end());
    }
  }

 private:
  std::vector<std::vector<Index>> rows_;
};

/// Replaces pivots of 0 by the largest pivot, or by 1 if all are 0.
void fill_pivots(double* block) {
  double largest = 0;
  for (int i = 0; i < kRigidModes; ++i) largest = std::max(largest, block[i * (kRigidModes + 1)]);
  for (int i = 0; i < kRigidModes; ++i) {
    double& pivot = block[i * (kRigidModes + 1)];
    if (pivot == 0) pivot = largest > 0 ? largest : 1;
  }
}

}  // namespace

template <int R>
ColumnBlocks column_blocks(const Prolongation<R>& prolongation) {
  ColumnBlocks result;
  result.offsets.assign(Offset{prolongation.columns_count} + 1, 0);
  for (const Index column : prolongation.columns) ++result.offsets[column + 1];
  std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
  result.rows.resize(prolongation.columns.size());
  result.blocks.resize(prolongation.columns.size());
  std::vector<Offset> next(result.offsets.begin(), result.offsets.end() - 1);
  for (Index row = 0; row < prolongation.rows(); ++row) {
    for (Offset k = prolongation.offsets[row]; k < prolongation.offsets[row + 1]; ++k) {
      const Offset place = next[prolongation.columns[k]]++;
      result.rows[place] = row;
      result.blocks[place] = static_cast<Index>(k);
    }
  }
  return result;
}

template <int R>
CoarseMatrix galerkin_pattern(const BlockView<R>& fine, const Prolongation<R>& p,
                              const ColumnBlocks& transposed) {
  CoarseMatrix coarse;
  coarse.columns_count = p.columns_count;
  PatternParts rows(p.columns_count);
  for_each_share(p.columns_count, [&](Index begin, Index end) {
    ColumnSet through(fine.rows());
    ColumnSet met(p.columns_count);
    for (Index a = begin; a < end; ++a) {
      met.place(a);
      for (Offset m = transposed.offsets[a]; m < transposed.offsets[a + 1]; ++m) {
        fine.for_each_in_row(transposed.rows[m], [&](Index j, const double*) { through.place(j); });
      }
      for (const Index j : through.columns()) {
        for (Offset k = p.offsets[j]; k < p.offsets[j + 1]; ++k) met.place(p.columns[k]);
      }
      rows.row(a) = met.columns();
      std::sort(rows.row(a).begin(), rows.row(a).end());
      through.clear();
      met.clear();
    }
  });
  rows.put_into(coarse);
  return coarse;
}

template <int R>
void galerkin_product(const BlockView<R>& fine, const Prolongation<R>& p, const ColumnBlocks& transposed,
                      CoarseMatrix& coarse) {
  using Half = Block<kRigidModes, R>;
  constexpr int kCoarse = CoarseMatrix::kEntries;
  coarse.values.resize(kCoarse * coarse.columns.size());
  // the lower triangle
  for_each_share(coarse.rows(), [&](Index begin, Index end) {
    ColumnSet through(fine.rows());
    std::vector<double> halves;  // blocks of row a of Pᵀ A, 6×R each
    std::vector<Offset> place(coarse.rows());
    for (Index a = begin; a < end; ++a) {
      for (Offset m = transposed.offsets[a]; m < transposed.offsets[a + 1]; ++m) {
        const Half restriction = Eigen::Map<const FloatBlock<R, kRigidModes>>(p.block(transposed.blocks[m]))
                                     .transpose()
                                     .template cast<double>();
        fine.for_each_in_row(transposed.rows[m], [&](Index j, const double* block) {
          if (p.offsets[j] == p.offsets[j + 1] || p.columns[p.offsets[j]] > a) return;
          const Offset at = Offset{Half::SizeAtCompileTime} * through.place(j);
          if (at == static_cast<Offset>(halves.size())) halves.resize(at + Half::SizeAtCompileTime, 0.0);
          Eigen::Map<Half>(halves.data() + at).noalias() +=
              restriction.lazyProduct(Eigen::Map<const Block<R, R>>(block));
        });
      }
      for (Offset k = coarse.offsets[a]; k < coarse.offsets[a + 1]; ++k) {
        place[coarse.columns[k]] = k;
        std::fill_n(coarse.block(k), kCoarse, 0.0);
      }
      const double* half = halves.data();
      for (const Index j : through.columns()) {
        for (Offset k = p.offsets[j]; k < p.offsets[j + 1] && p.columns[k] <= a; ++k) {
          Eigen::Map<Block<kRigidModes, kRigidModes>>(coarse.block(place[p.columns[k]])).noalias() +=
              Eigen::Map<const Half>(half).lazyProduct(
                  Eigen::Map<const FloatBlock<R, kRigidModes>>(p.block(k)).template cast<double>());
        }
        half += Half::SizeAtCompileTime;
      }
      fill_pivots(coarse.block(place[a]));
      through.clear();
      halves.clear();
    }
  });
  // the upper triangle
  for_each_share(coarse.rows(), [&](Index begin, Index end) {
    for (Index a = begin; a < end; ++a) {
      for (Offset k = coarse.offsets[a]; k < coarse.offsets[a + 1]; ++k) {
        const Index b = coarse.columns[k];
        if (b <= a) continue;
        const auto row = coarse.columns.begin() + coarse.offsets[b];
        const auto row_end = coarse.columns.begin() + coarse.offsets[b + 1];
        const Offset mirrored = std::lower_bound(row, row_end, a) - coarse.columns.begin();
        Eigen::Map<Block<kRigidModes, kRigidModes>>(coarse.block(k)) =
            Eigen::Map<const Block<kRigidModes, kRigidModes>>(coarse.block(mirrored)).transpose();
      }
    }
  });
}

Prolongation<kRigidModes> smoothed_pattern(const BlockView<kRigidModes>& matrix,
                                           const Prolongation<kRigidModes>& tentative) {
  Prolongation<kRigidModes> result;
  result.columns_count = tentative.columns_count;
  PatternParts rows(matrix.rows());
  for_each_share(matrix.rows(), [&](Index begin, Index end) {
    ColumnSet met(tentative.columns_count);
    for (Index i = begin; i < end; ++i) {
      matrix.for_each_in_row(i, [&](Index j, const double*) {
        for (Offset k = tentative.offsets[j]; k < tentative.offsets[j + 1]; ++k) {
          met.place(tentative.columns[k]);
        }
      });
      rows.row(i) = met.columns();
      std::sort(rows.row(i).begin(), rows.row(i).end());
      met.clear();
    }
  });
  rows.put_into(result);
  return result;
}

void smooth_prolongation(const BlockView<kRigidModes>& matrix, std::span<const float> inverse_diagonal,
                         double omega, const Prolongation<kRigidModes>& tentative,
                         Prolongation<kRigidModes>& smoothed) {
  using Square = Block<kRigidModes, kRigidModes>;
  using FloatSquare = FloatBlock<kRigidModes, kRigidModes>;
  constexpr int kEntries = Prolongation<kRigidModes>::kEntries;
  smoothed.values.resize(kEntries * smoothed.columns.size() + Prolongation<kRigidModes>::kRoom);
  for_each_share(matrix.rows(), [&](Index begin, Index end) {
    std::vector<double> row;
    std::vector<Index> place(smoothed.columns_count);
    for (Index i = begin; i < end; ++i) {
      const Offset first = smoothed.offsets[i];
      for (Offset k = first; k < smoothed.offsets[i + 1]; ++k) {
        place[smoothed.columns[k]] = static_cast<Index>(k - first);
      }
      row.assign(kEntries * (smoothed.offsets[i + 1] - first), 0.0);
      matrix.for_each_in_row(i, [&](Index j, const double* block) {
        for (Offset k = tentative.offsets[j]; k < tentative.offsets[j + 1]; ++k) {
          Eigen::Map<Square>(row.data() + Offset{kEntries} * place[tentative.columns[k]]).noalias() +=
              Eigen::Map<const Square>(block).lazyProduct(
                  Eigen::Map<const FloatSquare>(tentative.block(k)).cast<double>());
        }
      });
      // a block of D⁻¹ is symmetric
      const Square scale =
          -omega *
          Eigen::Map<const FloatSquare>(inverse_diagonal.data() + Offset{kEntries} * i).cast<double>();
      for (Offset k = first; k < smoothed.offsets[i + 1]; ++k) {
        Eigen::Map<FloatSquare>(smoothed.block(k)) =
            (scale * Eigen::Map<const Square>(row.data() + kEntries * (k - first))).cast<float>();
      }
      for (Offset k = tentative.offsets[i]; k < tentative.offsets[i + 1]; ++k) {
        Eigen::Map<FloatSquare>(smoothed.block(first + place[tentative.columns[k]])) +=
            Eigen::Map<const FloatSquare>(tentative.block(k));
      }
    }
  });
}

template ColumnBlocks column_blocks<3>(const Prolongation<3>&);
template ColumnBlocks column_blocks<6>(const Prolongation<6>&);
template CoarseMatrix galerkin_pattern<3>(const BlockView<3>&, const Prolongation<3>&, const ColumnBlocks&);
template CoarseMatrix galerkin_pattern<6>(const BlockView<6>&, const Prolongation<6>&, const ColumnBlocks&);
template void galerkin_product<3>(const BlockView<3>&, const Prolongation<3>&, const ColumnBlocks&,
                                  CoarseMatrix&);
template void galerkin_product<6>(const BlockView<6>&, const Prolongation<6>&, const ColumnBlocks&,
                                  CoarseMatrix&);

}  // namespace meshorder
