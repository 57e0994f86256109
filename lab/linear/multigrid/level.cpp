// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/level.hpp"

#include "lab/linear/multigrid/rigid_modes.hpp"
#include "spectral/aggregation.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <utility>

namespace meshorder {
namespace {

/// Returns the graph of the blocks off the diagonal that are not 0, weighted by their norms.
template <int R>
Laplacian graph_of_norms(const BlockView<R>& matrix) {
  Laplacian graph;
  graph.offsets.reserve(Offset{matrix.rows()} + 1);
  graph.neighbours.reserve(matrix.columns.size());
  graph.weights.reserve(matrix.columns.size());
  for (Index i = 0; i < matrix.rows(); ++i) {
    double sum = 0;
    matrix.for_each_in_row(i, [&](Index j, const double* block) {
      const double norm = Eigen::Map<const Eigen::Matrix<double, R * R, 1>>(block).norm();
      if (j == i || !(norm > 0)) return;
      graph.neighbours.push_back(j);
      graph.weights.push_back(norm);
      sum += norm;
    });
    graph.offsets.push_back(static_cast<Offset>(graph.neighbours.size()));
    graph.diagonal.push_back(sum);
  }
  return graph;
}

/// Returns the aggregates of the nodes that have neighbours. Aggregates are larger if the prolongation is
/// smoothed.
Aggregates aggregates_of(const Laplacian& graph, Coarsening coarsening) {
  // smallest norm of a strong neighbour's block, relative to the row's largest norm
  const double strength = coarsening == Coarsening::plain ? 0.25 : 0.04;
  const Aggregation all = aggregate(graph, RowChunks::whole(graph.size()), strength);
  const auto has_neighbours = [&](Index i) { return graph.offsets[i] < graph.offsets[i + 1]; };
  std::vector<Index> sizes(all.count(), 0);
  Index members = 0;
  for (Index i = 0; i < graph.size(); ++i) {
    if (!has_neighbours(i)) continue;
    ++sizes[all.aggregate_of[i]];
    ++members;
  }
  Aggregates result;
  std::vector<Index> next;  // the place of each aggregate's next member
  for (const Index size : sizes) {
    next.push_back(result.starts.back());
    if (size > 0) result.starts.push_back(result.starts.back() + size);
  }
  result.members.resize(members);
  for (Index i = 0; i < graph.size(); ++i) {
    if (has_neighbours(i)) result.members[next[all.aggregate_of[i]]++] = i;
  }
  return result;
}

/// Returns ω = 4/3 divided by the spectral radius of D⁻¹ A, which the power method estimates.
double smoothing_of(const BlockView<kRigidModes>& matrix, const AlignedVector<float>& inverse_diagonal) {
  constexpr int kSteps = 12;
  constexpr double kMargin = 1.1;  // since the power method underestimates
  using Vector = Eigen::Matrix<double, kRigidModes, 1>;
  using Square = Eigen::Matrix<double, kRigidModes, kRigidModes, Eigen::RowMajor>;
  const Eigen::Index n = Eigen::Index{kRigidModes} * matrix.rows();
  Eigen::VectorXd x =
      Eigen::VectorXd::NullaryExpr(n, [](Eigen::Index i) { return static_cast<double>(i * 7 % 11 - 5); });
  Eigen::VectorXd y(n);
  double radius = 1;
  for (int step = 0; step < kSteps; ++step) {
    constexpr Index kRows = 64;
    for_each_chunk(matrix.rows(), kRows, [&](Index, Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        Vector sum = Vector::Zero();
        matrix.for_each_in_row(i, [&](Index j, const double* block) {
          sum += Eigen::Map<const Square>(block) * x.segment<kRigidModes>(Eigen::Index{kRigidModes} * j);
        });
        const auto* const inverse = inverse_diagonal.data() + Offset{Square::SizeAtCompileTime} * i;
        y.segment<kRigidModes>(Eigen::Index{kRigidModes} * i) =
            Eigen::Map<const Eigen::Matrix<float, kRigidModes, kRigidModes>>(inverse).cast<double>() * sum;
      }
    });
    const double before = x.norm();
    const double after = y.norm();
    if (!(after > 0) || !std::isfinite(after)) break;
    radius = after / before;
    x = y / after;
  }
  return 4.0 / 3.0 / (kMargin * radius);
}

}  // namespace

template <int R>
std::size_t MultigridLevel<R>::bytes() const {
  return sweeps.bytes() + prolongation.bytes() + tentative.bytes() + coarse.bytes() +
         sizeof(Offset) * transposed.offsets.capacity() +
         sizeof(Index) * (transposed.rows.capacity() + transposed.blocks.capacity());
}

template <int R>
MultigridLevel<R> make_level(const BlockView<R>& matrix, Coarsening coarsening, std::vector<double>& modes) {
  constexpr double kWorthwhile = 0.8;  // coarsening is given up if it keeps a larger share of the nodes
  MultigridLevel<R> level;
  level.sweeps = BlockSweeps<R>(matrix);
  level.sweeps.update(matrix);
  const Aggregates aggregates = aggregates_of(graph_of_norms(matrix), coarsening);
  if (aggregates.count() > kWorthwhile * matrix.rows()) return level;
  RigidProlongation<R> rigid = rigid_prolongation<R>(aggregates, matrix.rows(), modes);
  modes = std::move(rigid.coarse_modes);
  level.prolongation = std::move(rigid.prolongation);
  if constexpr (R == kRigidModes) {
    if (coarsening == Coarsening::smoothed) {
      level.tentative = std::move(level.prolongation);
      level.prolongation = smoothed_pattern(matrix, level.tentative);
      level.smoothing = smoothing_of(matrix, level.sweeps.inverse_diagonal());
    }
  }
  level.transposed = column_blocks<R>(level.prolongation);
  level.coarse = galerkin_pattern<R>(matrix, level.prolongation, level.transposed);
  return level;
}

template <int R>
void update_level(const BlockView<R>& matrix, MultigridLevel<R>& level) {
  level.sweeps.update(matrix);
  if (level.is_coarsest()) return;
  if constexpr (R == kRigidModes) {
    if (level.smoothing > 0) {
      smooth_prolongation(matrix, level.sweeps.inverse_diagonal(), level.smoothing, level.tentative,
                          level.prolongation);
    }
  }
  galerkin_product<R>(matrix, level.prolongation, level.transposed, level.coarse);
}

template struct MultigridLevel<3>;
template struct MultigridLevel<6>;
template MultigridLevel<3> make_level(const BlockView<3>&, Coarsening, std::vector<double>&);
template MultigridLevel<6> make_level(const BlockView<6>&, Coarsening, std::vector<double>&);
template void update_level(const BlockView<3>&, MultigridLevel<3>&);
template void update_level(const BlockView<6>&, MultigridLevel<6>&);

}  // namespace meshorder
