// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/hierarchy.hpp"

#include "spectral/hiding.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace meshorder {
namespace {

constexpr Index kDenseSize = 60;     // a dense eigensolver takes half a millisecond at this size
constexpr Index kSmallGraph = 1024;  // a search takes less than a millisecond up to this size
constexpr Index kExactSize = 128;    // counting eigenvalues by pivots takes 0.1 ms at this size

/// Makes the next coarser level of `fine`, and stores the transfer to it in `fine`. Returns false if
/// coarsening is not worthwhile.
bool coarsen(Level& fine, bool smoothed, Level& coarse) {
  constexpr Index kFewAlone = 50;  // chunks are kept if at most one vertex in 50 is alone
  const Index n = fine.laplacian.size();
  Aggregation aggregation = aggregate(fine.laplacian, fine.chunks, kStrength, fine.masses);
  if (aggregation.alone > n / kFewAlone && fine.chunks.count() > 1) {
    fine.chunks = RowChunks::whole(n);
    aggregation = aggregate(fine.laplacian, fine.chunks, kStrength, fine.masses);
  }
  if (aggregation.count() > kWorthwhile * n) return false;
  if (smoothed) {
    fine.prolongation = smoothed_prolongation(fine.laplacian, aggregation);
    // smoothing is left out if it makes the coarse graph too dense
    const Offset most = 2 * std::ssize(fine.laplacian.neighbours);
    std::optional<Laplacian> product = galerkin_product(fine.laplacian, fine.prolongation, most);
    smoothed = product.has_value();
    if (smoothed) coarse.laplacian = *std::move(product);
  }
  coarse.masses.assign(aggregation.count(), 0);
  if (smoothed) {
    const SparseRows& p = fine.prolongation;
    for (Index v = 0; v < n; ++v) {
      for (Offset k = p.offsets[v]; k < p.offsets[v + 1]; ++k) {
        coarse.masses[p.columns[k]] += p.values[k] * fine.mass(v);
      }
    }
  } else {
    fine.prolongation = {};
    coarse.laplacian = collapsed(fine.laplacian, fine.chunks, aggregation);
    for (Index v = 0; v < n; ++v) coarse.masses[aggregation.aggregate_of[v]] += fine.mass(v);
  }
  fine.aggregation = std::move(aggregation);
  coarse.chunks = RowChunks(coarse.laplacian);
  return true;
}

Eigen::MatrixXd dense(const Laplacian& laplacian) {
  const Index n = laplacian.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Index v = 0; v < n; ++v) {
    matrix(v, v) = laplacian.diagonal[v];
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      matrix(v, laplacian.neighbours[k]) -= laplacian.is_weighted() ? laplacian.weights[k] : 1.0;
    }
  }
  return 0.5 * (matrix + matrix.transpose());
}

/// Returns the inverse of L on the space of vectors whose entries sum to 0.
Eigen::MatrixXd dense_inverse(const Laplacian& laplacian) {
  const Index n = laplacian.size();
  Eigen::MatrixXd shifted = dense(laplacian);
  const double scale = shifted.diagonal().maxCoeff();
  if (!(scale > 0)) return Eigen::MatrixXd::Zero(n, n);  // one vertex
  shifted.array() += scale / n;                          // removes the constant vector from the null space
  return shifted.llt().solve(Eigen::MatrixXd::Identity(n, n));
}

template <int M, class RightSide>
void forward_gauss_seidel(const Level& level, RightSide b, VectorBlock<M>& x) {
  level.chunks.for_each_forwards(in_rising_pieces([&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) relax_row<M>(level.laplacian, v, b, x);
  }));
}

/// Relaxes the rows in the opposite order, so that the cycle is symmetric.
template <int M, class RightSide>
void backward_gauss_seidel(const Level& level, RightSide b, VectorBlock<M>& x) {
  level.chunks.for_each_backwards(in_falling_pieces([&](Index begin, Index end) {
    for (Index v = end; v-- > begin;) relax_row<M>(level.laplacian, v, b, x);
  }));
}

/// Computes result = Pᵀ (b − L x).
template <int M>
void restrict_residual(const Level& level, const VectorBlock<M>& b, const VectorBlock<M>& x,
                       VectorBlock<M>& result) {
  std::fill(result.begin(), result.end(), std::array<double, M>{});
  if (!level.is_smoothed()) {
    level.chunks.for_each_piece([&](Index begin, Index end) {  // no aggregate spans two chunks
      for (Index v = begin; v < end; ++v) {
        const auto residual = residual_of_row<M>(level.laplacian, v, b, x);
        for (int m = 0; m < M; ++m) result[level.aggregation.aggregate_of[v]][m] += residual[m];
      }
    });
    return;
  }
  const SparseRows& p = level.prolongation;
  for (Index v = 0; v < level.laplacian.size(); ++v) {
    const auto residual = residual_of_row<M>(level.laplacian, v, b, x);
    for (Offset k = p.offsets[v]; k < p.offsets[v + 1]; ++k) {
      for (int m = 0; m < M; ++m) result[p.columns[k]][m] += p.values[k] * residual[m];
    }
  }
}

}  // namespace

Hierarchy::Hierarchy(Laplacian finest) {
  levels_.emplace_back();
  levels_.back().laplacian = std::move(finest);
  coarsen_all(false);
}

Hierarchy::Hierarchy(Laplacian coarse, std::vector<double> masses) {
  levels_.emplace_back();
  levels_.back().laplacian = std::move(coarse);
  levels_.back().masses = std::move(masses);
  coarsen_all(true);
}

/// Makes all levels that are coarser than the finest level.
void Hierarchy::coarsen_all(bool smoothed) {
  levels_.back().chunks = RowChunks(levels_.back().laplacian);
  while (levels_.back().laplacian.size() > kDenseSize) {
    Level coarse;
    if (!coarsen(levels_.back(), smoothed || levels_.size() > 1, coarse)) break;
    levels_.push_back(std::move(coarse));
  }
  const Laplacian& coarsest = levels_.back().laplacian;
  if (coarsest.size() <= kDenseSize) {
    coarsest_inverse_ = dense_inverse(coarsest);
  }
}

bool Hierarchy::may_hide(int level, double eigenvalue) const {
  const Level& fine = levels_[level];
  const Index n = fine.laplacian.size();
  if (n <= kExactSize) return has_two_below(fine.laplacian, fine.masses, eigenvalue);
  return !has_exact_coarsest() || (level == 0 && n <= kSmallGraph) ||
         meshorder::may_hide(fine.laplacian, fine.aggregation, fine.masses, eigenvalue);
}

template <int M>
void Hierarchy::smooth(int level, VectorBlock<M>& x) const {
  const auto zero = [](Index, int) { return 0.0; };
  forward_gauss_seidel<M>(levels_[level], zero, x);
  backward_gauss_seidel<M>(levels_[level], zero, x);
}

template <int M>
void Hierarchy::add_prolonged(int level, double scale, const VectorBlock<M>& coarse,
                              VectorBlock<M>& fine) const {
  const Level& here = levels_[level];
  const SparseRows& p = here.prolongation;
  here.chunks.for_each_piece([&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      if (!here.is_smoothed()) {
        for (int m = 0; m < M; ++m) fine[v][m] += scale * coarse[here.aggregation.aggregate_of[v]][m];
        continue;
      }
      for (Offset k = p.offsets[v]; k < p.offsets[v + 1]; ++k) {
        for (int m = 0; m < M; ++m) fine[v][m] += scale * p.values[k] * coarse[p.columns[k]][m];
      }
    }
  });
}

template <int M>
void Hierarchy::cycle(int level, const VectorBlock<M>& b, VectorBlock<M>& x,
                      CycleWorkspace<M>& workspace) const {
  const Level& here = levels_[level];
  const auto size = static_cast<std::size_t>(here.laplacian.size());
  const int coarsest = static_cast<int>(levels_.size()) - 1;
  if (level == coarsest && has_exact_coarsest()) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, M, M == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
    x.resize(size);
    Eigen::Map<Rows>(x.front().data(), here.laplacian.size(), M).noalias() =
        coarsest_inverse_ * Eigen::Map<const Rows>(b.front().data(), here.laplacian.size(), M);
    return;
  }
  x.assign(size, std::array<double, M>{});
  const auto entry_of_b = [&](Index v, int m) { return b[v][m]; };
  forward_gauss_seidel<M>(here, entry_of_b, x);
  if (level < coarsest) {
    workspace.levels.resize(levels_.size());
    VectorBlock<M>& coarse_b = workspace.levels[level + 1].right_side;
    VectorBlock<M>& coarse_x = workspace.levels[level + 1].correction;
    VectorBlock<M>& second_x = workspace.levels[level + 1].second_correction;
    coarse_b.resize(levels_[level + 1].laplacian.size());
    restrict_residual<M>(here, b, x, coarse_b);
    two_cycles<M>(level + 1, coarse_b, coarse_x, second_x, workspace);
    add_prolonged<M>(level, here.is_smoothed() ? 1 : kOverCorrection, coarse_x, x);
  }
  backward_gauss_seidel<M>(here, entry_of_b, x);
}

template <int M>
void Hierarchy::two_cycles(int level, VectorBlock<M>& b, VectorBlock<M>& x, VectorBlock<M>& second_x,
                           CycleWorkspace<M>& workspace) const {
  const Level& here = levels_[level];
  cycle<M>(level, b, x, workspace);
  if (level == static_cast<int>(levels_.size()) - 1) return;
  here.chunks.for_each_piece([&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) b[v] = residual_of_row<M>(here.laplacian, v, b, x);
  });
  cycle<M>(level, b, second_x, workspace);
  for (std::size_t v = 0; v < x.size(); ++v) {
    for (int m = 0; m < M; ++m) x[v][m] += second_x[v][m];
  }
}

template <int M>
VectorBlock<M> Hierarchy::coarsest_eigenvectors() const {
  const Level& coarsest = levels_.back();
  const Index n = coarsest.laplacian.size();
  const Eigen::VectorXd scale = Eigen::VectorXd::NullaryExpr(
      n, [&](Eigen::Index v) { return 1 / std::sqrt(coarsest.mass(static_cast<Index>(v))); });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * dense(coarsest.laplacian) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> pairs(scaled);
  VectorBlock<M> result(n, std::array<double, M>{});
  for (int m = 0; m < std::min<int>(M, n - 1); ++m) {
    for (Index v = 0; v < n; ++v) result[v][m] = scale[v] * pairs.eigenvectors()(v, m + 1);
  }
  return result;
}

template void Hierarchy::add_prolonged<1>(int, double, const VectorBlock<1>&, VectorBlock<1>&) const;
template void Hierarchy::cycle<1>(int, const VectorBlock<1>&, VectorBlock<1>&, CycleWorkspace<1>&) const;
template void Hierarchy::two_cycles<1>(int, VectorBlock<1>&, VectorBlock<1>&, VectorBlock<1>&,
                                       CycleWorkspace<1>&) const;
template void Hierarchy::smooth<1>(int, VectorBlock<1>&) const;
template VectorBlock<1> Hierarchy::coarsest_eigenvectors<1>() const;
template void Hierarchy::add_prolonged<2>(int, double, const VectorBlock<2>&, VectorBlock<2>&) const;
template void Hierarchy::cycle<2>(int, const VectorBlock<2>&, VectorBlock<2>&, CycleWorkspace<2>&) const;
template void Hierarchy::two_cycles<2>(int, VectorBlock<2>&, VectorBlock<2>&, VectorBlock<2>&,
                                       CycleWorkspace<2>&) const;
template void Hierarchy::smooth<2>(int, VectorBlock<2>&) const;
template VectorBlock<2> Hierarchy::coarsest_eigenvectors<2>() const;

}  // namespace meshorder
