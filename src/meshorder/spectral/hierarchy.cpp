// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/spectral/aggregation.hpp>
#include <meshorder/spectral/hierarchy.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace meshorder {
namespace {

constexpr Index kDenseSize = 100;         // a dense eigensolver takes under 2 ms there
constexpr double kStrength = 0.1;         // of the strongest neighbour, on coarse levels
constexpr double kSmoothing = 2.0 / 3.0;  // 4/3 over the bound 2 of the spectral radius of D⁻¹L
constexpr double kWorthwhile = 0.8;       // coarsening that keeps more vertices than this is given up

/// The rows of L with their diagonals.
SparseRows rows_of(const Laplacian& laplacian) {
  SparseRows rows;
  const Index n = laplacian.size();
  rows.columns_count = n;
  rows.offsets.reserve(Offset{n} + 1);
  rows.columns.reserve(laplacian.neighbours.size() + n);
  rows.values.reserve(laplacian.neighbours.size() + n);
  for (Index v = 0; v < n; ++v) {
    rows.columns.push_back(v);
    rows.values.push_back(laplacian.diagonal[v]);
    for (Offset k = laplacian.offsets[v]; k < laplacian.offsets[v + 1]; ++k) {
      rows.columns.push_back(laplacian.neighbours[k]);
      rows.values.push_back(laplacian.is_weighted() ? -laplacian.weights[k] : -1.0);
    }
    rows.offsets.push_back(static_cast<Offset>(rows.columns.size()));
  }
  return rows;
}

/// The Laplacian whose off-diagonal entries are those of `rows`; the diagonal is what makes constants vanish.
Laplacian laplacian_of(const SparseRows& rows) {
  Laplacian result;
  const Index n = rows.rows();
  result.offsets.reserve(rows.offsets.size());
  result.diagonal.assign(n, 0);
  for (Index v = 0; v < n; ++v) {
    for (Offset k = rows.offsets[v]; k < rows.offsets[v + 1]; ++k) {
      if (rows.columns[k] == v) continue;
      result.neighbours.push_back(rows.columns[k]);
      result.weights.push_back(-rows.values[k]);
      result.diagonal[v] -= rows.values[k];
    }
    result.offsets.push_back(static_cast<Offset>(result.neighbours.size()));
  }
  return result;
}

/// Vertices by aggregate: those of a are `members[starts[a]] … members[starts[a + 1] − 1]`.
struct Members {
  std::vector<Index> starts;
  std::vector<Index> members;
};

Members members_of(const Aggregation& aggregation) {
  Members result;
  result.starts.assign(Offset{aggregation.count} + 1, 0);
  for (const Index a : aggregation.aggregate_of) ++result.starts[a + 1];
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  std::vector<Index> next(result.starts.begin(), result.starts.end() - 1);
  result.members.resize(aggregation.aggregate_of.size());
  for (Index v = 0; v < index_size(aggregation.aggregate_of); ++v) {
    result.members[next[aggregation.aggregate_of[v]]++] = v;
  }
  return result;
}

/// Pᵀ L P for piecewise constant P: the weights between two aggregates added up.
Laplacian collapsed(const Laplacian& fine, const Aggregation& aggregation) {
  const Members members = members_of(aggregation);
  const std::vector<Index>& of = aggregation.aggregate_of;
  Laplacian coarse;
  coarse.offsets.reserve(Offset{aggregation.count} + 1);
  coarse.diagonal.assign(aggregation.count, 0);
  std::vector<Offset> place_of(aggregation.count, -1);
  for (Index a = 0; a < aggregation.count; ++a) {
    const auto begin = static_cast<Offset>(coarse.neighbours.size());
    for (Index m = members.starts[a]; m < members.starts[a + 1]; ++m) {
      const Index v = members.members[m];
      for (Offset k = fine.offsets[v]; k < fine.offsets[v + 1]; ++k) {
        const Index b = of[fine.neighbours[k]];
        if (b == a) continue;
        const double weight = fine.is_weighted() ? fine.weights[k] : 1.0;
        if (place_of[b] >= begin) {
          coarse.weights[place_of[b]] += weight;
        } else {
          place_of[b] = static_cast<Offset>(coarse.neighbours.size());
          coarse.neighbours.push_back(b);
          coarse.weights.push_back(weight);
        }
        coarse.diagonal[a] += weight;
      }
    }
    coarse.offsets.push_back(static_cast<Offset>(coarse.neighbours.size()));
  }
  return coarse;
}

/// (I − ω D⁻¹ L) P₀ with P₀ piecewise constant. Rows sum to 1, as those of P₀ do.
SparseRows smoothed_prolongation(const Laplacian& fine, const Aggregation& aggregation) {
  SparseRows result;
  result.columns_count = aggregation.count;
  result.offsets.reserve(Offset{fine.size()} + 1);
  std::vector<Offset> place_of(aggregation.count, -1);
  for (Index v = 0; v < fine.size(); ++v) {
    const auto begin = static_cast<Offset>(result.columns.size());
    const auto add = [&](Index column, double value) {
      if (place_of[column] >= begin) {
        result.values[place_of[column]] += value;
      } else {
        place_of[column] = static_cast<Offset>(result.columns.size());
        result.columns.push_back(column);
        result.values.push_back(value);
      }
    };
    add(aggregation.aggregate_of[v], 1 - kSmoothing);
    for (Offset k = fine.offsets[v]; k < fine.offsets[v + 1]; ++k) {
      const double weight = fine.is_weighted() ? fine.weights[k] : 1.0;
      add(aggregation.aggregate_of[fine.neighbours[k]], kSmoothing * weight / fine.diagonal[v]);
    }
    result.offsets.push_back(static_cast<Offset>(result.columns.size()));
  }
  return result;
}

/// Makes the next coarser level of `fine`, and in `fine` the way to it; false when that is not worth it.
bool coarsen(Level& fine, bool smoothed, Level& coarse) {
  const Aggregation aggregation = aggregate(fine.laplacian, kStrength);
  if (aggregation.count > kWorthwhile * fine.laplacian.size()) return false;
  coarse.mass.assign(aggregation.count, 0);
  if (smoothed) {
    SparseRows prolongation = smoothed_prolongation(fine.laplacian, aggregation);
    const SparseRows coarse_rows =
        product(transposed(prolongation), product(rows_of(fine.laplacian), prolongation));
    if (coarse_rows.columns.size() > 2 * fine.laplacian.neighbours.size()) {
      return coarsen(fine, false, coarse);  // smoothing would fill the coarse graph
    }
    coarse.laplacian = laplacian_of(coarse_rows);
    for (Index v = 0; v < prolongation.rows(); ++v) {
      for (Offset k = prolongation.offsets[v]; k < prolongation.offsets[v + 1]; ++k) {
        coarse.mass[prolongation.columns[k]] += prolongation.values[k] * fine.mass[v];
      }
    }
    fine.prolongation = std::move(prolongation);
  } else {
    coarse.laplacian = collapsed(fine.laplacian, aggregation);
    for (Index v = 0; v < fine.laplacian.size(); ++v) {
      coarse.mass[aggregation.aggregate_of[v]] += fine.mass[v];
    }
    fine.aggregate_of = aggregation.aggregate_of;
  }
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

/// The inverse of L on the vectors that sum to 0.
Eigen::MatrixXd dense_inverse(const Laplacian& laplacian) {
  const Index n = laplacian.size();
  Eigen::MatrixXd shifted = dense(laplacian);
  const double scale = shifted.diagonal().maxCoeff();
  if (!(scale > 0)) return Eigen::MatrixXd::Zero(n, n);  // one vertex
  shifted.array() += scale / n;                          // lifts the constant vector out of the null space
  return shifted.llt().solve(Eigen::MatrixXd::Identity(n, n));
}

template <int M>
void smooth_row(const Laplacian& laplacian, Index v, const VectorBlock<M>& b, VectorBlock<M>& x) {
  const auto sum = laplacian.neighbour_sum<M>(v, x);
  const double inverse = 1 / laplacian.diagonal[v];
  for (int m = 0; m < M; ++m) x[v][m] = (b[v][m] + sum[m]) * inverse;
}

template <int M>
void forward_gauss_seidel(const Laplacian& laplacian, const VectorBlock<M>& b, VectorBlock<M>& x) {
  for (Index v = 0; v < laplacian.size(); ++v) smooth_row<M>(laplacian, v, b, x);
}

template <int M>
void backward_gauss_seidel(const Laplacian& laplacian, const VectorBlock<M>& b, VectorBlock<M>& x) {
  for (Index v = laplacian.size(); v-- > 0;) smooth_row<M>(laplacian, v, b, x);
}

/// Pᵀ (b − L x)
template <int M>
VectorBlock<M> restricted_residual(const Level& level, Index coarse_size, const VectorBlock<M>& b,
                                   const VectorBlock<M>& x) {
  VectorBlock<M> result(coarse_size, std::array<double, M>{});
  for (Index v = 0; v < level.laplacian.size(); ++v) {
    std::array<double, M> residual = level.laplacian.neighbour_sum<M>(v, x);
    for (int m = 0; m < M; ++m) residual[m] += b[v][m] - level.laplacian.diagonal[v] * x[v][m];
    if (!level.aggregate_of.empty()) {
      for (int m = 0; m < M; ++m) result[level.aggregate_of[v]][m] += residual[m];
    } else {
      const SparseRows& p = level.prolongation;
      for (Offset k = p.offsets[v]; k < p.offsets[v + 1]; ++k) {
        for (int m = 0; m < M; ++m) result[p.columns[k]][m] += p.values[k] * residual[m];
      }
    }
  }
  return result;
}

}  // namespace

Hierarchy::Hierarchy(Laplacian finest) {
  Level level;
  level.mass.assign(finest.size(), 1.0);
  level.laplacian = std::move(finest);
  levels_.push_back(std::move(level));
  while (levels_.back().laplacian.size() > kDenseSize) {
    Level coarse;
    if (!coarsen(levels_.back(), levels_.size() > 1, coarse)) break;
    levels_.push_back(std::move(coarse));
  }
  const Laplacian& coarsest = levels_.back().laplacian;
  if (coarsest.size() <= kDenseSize) coarsest_inverse_ = dense_inverse(coarsest);
}

template <int M>
void Hierarchy::add_prolonged(int level, const VectorBlock<M>& coarse, VectorBlock<M>& fine) const {
  const Level& here = levels_[level];
  for (Index v = 0; v < here.laplacian.size(); ++v) {
    if (!here.aggregate_of.empty()) {
      for (int m = 0; m < M; ++m) fine[v][m] += coarse[here.aggregate_of[v]][m];
    } else {
      const SparseRows& p = here.prolongation;
      for (Offset k = p.offsets[v]; k < p.offsets[v + 1]; ++k) {
        for (int m = 0; m < M; ++m) fine[v][m] += p.values[k] * coarse[p.columns[k]][m];
      }
    }
  }
}

template <int M>
void Hierarchy::v_cycle(int level, const VectorBlock<M>& b, VectorBlock<M>& x) const {
  const Laplacian& laplacian = levels_[level].laplacian;
  const bool coarsest = level + 1 == static_cast<int>(levels_.size());
  if (coarsest && has_exact_coarsest()) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, M, M == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
    x.resize(b.size());
    Eigen::Map<Rows>(x.front().data(), laplacian.size(), M).noalias() =
        coarsest_inverse_ * Eigen::Map<const Rows>(b.front().data(), laplacian.size(), M);
    return;
  }
  x.assign(laplacian.size(), std::array<double, M>{});
  forward_gauss_seidel<M>(laplacian, b, x);
  if (!coarsest) {
    const Index coarse_size = levels_[level + 1].laplacian.size();
    const VectorBlock<M> coarse_b = restricted_residual<M>(levels_[level], coarse_size, b, x);
    VectorBlock<M> coarse_x;
    v_cycle<M>(level + 1, coarse_b, coarse_x);
    add_prolonged<M>(level, coarse_x, x);
  }
  backward_gauss_seidel<M>(laplacian, b, x);
}

template <int M>
VectorBlock<M> Hierarchy::coarsest_eigenvectors() const {
  const Level& coarsest = levels_.back();
  const Index n = coarsest.laplacian.size();
  const Eigen::VectorXd scale =
      Eigen::Map<const Eigen::VectorXd>(coarsest.mass.data(), n).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * dense(coarsest.laplacian) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  VectorBlock<M> result(n, std::array<double, M>{});
  for (int m = 0; m < std::min<int>(M, n - 1); ++m) {
    for (Index v = 0; v < n; ++v) result[v][m] = scale[v] * solver.eigenvectors()(v, m + 1);
  }
  return result;
}

template void Hierarchy::add_prolonged<1>(int, const VectorBlock<1>&, VectorBlock<1>&) const;
template void Hierarchy::add_prolonged<2>(int, const VectorBlock<2>&, VectorBlock<2>&) const;
template void Hierarchy::add_prolonged<3>(int, const VectorBlock<3>&, VectorBlock<3>&) const;
template void Hierarchy::v_cycle<1>(int, const VectorBlock<1>&, VectorBlock<1>&) const;
template void Hierarchy::v_cycle<2>(int, const VectorBlock<2>&, VectorBlock<2>&) const;
template void Hierarchy::v_cycle<3>(int, const VectorBlock<3>&, VectorBlock<3>&) const;
template VectorBlock<1> Hierarchy::coarsest_eigenvectors<1>() const;
template VectorBlock<2> Hierarchy::coarsest_eigenvectors<2>() const;
template VectorBlock<3> Hierarchy::coarsest_eigenvectors<3>() const;

}  // namespace meshorder
