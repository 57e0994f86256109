// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/linear/multigrid/multigrid.hpp"

#include "lab/linear/multigrid/level.hpp"
#include "lab/linear/multigrid/rigid_modes.hpp"
#include "lab/linear/preconditioners/symmetric_block.hpp"
#include "spectral/component_numbering.hpp"
#include <meshorder/error.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using Vector = AlignedVector<float>;

/// Returns the graph of the blocks off the diagonal.
CsrGraph graph_of(const BlockCsr& pattern) {
  CsrGraph graph;
  graph.offsets.reserve(pattern.offsets.size());
  graph.neighbours.reserve(pattern.columns.size());
  for (Index v = 0; v < pattern.size(); ++v) {
    for (Offset k = pattern.offsets[v]; k < pattern.offsets[v + 1]; ++k) {
      if (pattern.columns[k] != v) graph.neighbours.push_back(pattern.columns[k]);
    }
    graph.offsets.push_back(static_cast<Offset>(graph.neighbours.size()));
  }
  return graph;
}

/// Returns the inverse of a symmetric matrix after making its eigenvalues positive; 0 if the matrix is not
/// finite.
Eigen::MatrixXf dense_inverse(const CoarseMatrix& matrix) {
  constexpr double kMin = 1e-12;  // smallest eigenvalue, as a share of the largest
  const Eigen::Index n = Eigen::Index{kRigidModes} * matrix.rows();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (Index i = 0; i < matrix.rows(); ++i) {
    for (Offset k = matrix.offsets[i]; k < matrix.offsets[i + 1]; ++k) {
      dense.block<kRigidModes, kRigidModes>(Eigen::Index{kRigidModes} * i,
                                            Eigen::Index{kRigidModes} * matrix.columns[k]) =
          Eigen::Map<const Eigen::Matrix<double, kRigidModes, kRigidModes, Eigen::RowMajor>>(matrix.block(k));
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(dense);
  if (factor.info() == Eigen::Success && factor.rcond() > kMin) {
    return factor.solve(Eigen::MatrixXd::Identity(n, n)).cast<float>();
  }
  if (!dense.allFinite()) return Eigen::MatrixXf::Zero(n, n);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense);
  Eigen::VectorXd values = solver.eigenvalues().cwiseAbs();
  values = values.cwiseMax(kMin * values.maxCoeff()).cwiseInverse();
  return (solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose()).cast<float>();
}

/// The vectors of a cycle on one level.
template <int R>
struct LevelVectors {
  Vector b, x, residual;
  Vector before, first;  ///< for a second cycle
  typename BlockSweeps<R>::Given given;

  explicit LevelVectors(Index nodes) {
    const std::size_t size = std::size_t{kNodeStride<R>} * nodes;
    for (Vector* vector : {&b, &x, &residual, &before, &first, &given.from_below, &given.from_above}) {
      vector->assign(size, 0.0F);
    }
  }
  [[nodiscard]] std::size_t bytes() const { return 7 * sizeof(float) * b.capacity(); }
};

class Multigrid final : public Preconditioner {
 public:
  Multigrid(const BlockCsr& pattern, std::span<const Point> points)
      : Preconditioner(pattern.size()),
        points_(points.begin(), points.end()),
        finest_vectors_(pattern.size()) {
    if (index_size(points) != pattern.size()) {
      throw InvalidArgument("make_multigrid: a point is needed for each row of the matrix");
    }
    for (Index v = 0; v < pattern.size(); ++v) (void)diagonal_block(pattern, v);
    ComponentNumbering numbering = number_components(graph_of(pattern));
    order_ = std::move(numbering.order);
    number_.resize(order_.size());
    for (Index i = 0; i < index_size(order_); ++i) number_[order_[i]] = i;
  }

  [[nodiscard]] std::size_t bytes() const override {
    std::size_t result = finest_.bytes() + finest_vectors_.bytes() + sizeof(Point) * points_.capacity() +
                         sizeof(Index) * (order_.capacity() + number_.capacity()) +
                         sizeof(float) * coarsest_inverse_.size();
    for (const auto& level : coarse_) result += level.bytes();
    for (const auto& vectors : coarse_vectors_) result += vectors.bytes();
    return result;
  }

 private:
  void take(const BlockCsr& matrix) override {
    const BlockView<3> finest{matrix.offsets, matrix.columns, matrix.values, order_, number_};
    if (!is_made_) {
      make_levels(finest);
    } else {
      update_level(finest, finest_);
      CoarseMatrix* operator_of_level = &finest_.coarse;
      for (MultigridLevel<kRigidModes>& level : coarse_) {
        update_level(view(*operator_of_level), level);
        operator_of_level->values = std::vector<double>();
        operator_of_level = &level.coarse;
      }
      if (!finest_.is_coarsest()) coarsest_inverse_ = dense_inverse(*operator_of_level);
      operator_of_level->values = std::vector<double>();
    }
  }

  void multiply(std::span<const double> r, std::span<double> z) const override {
    if (!is_made_) throw InvalidArgument("multigrid: an update is needed first");
    constexpr Index kRows = 8192;
    LevelVectors<3>& here = finest_vectors_;
    for_each_chunk(index_size(order_), kRows, [&](Index, Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        for (int c = 0; c < 3; ++c) {
          here.b[Offset{kNodeStride<3>} * i + c] = static_cast<float>(r[Offset{3} * order_[i] + c]);
        }
      }
    });
    finest_.sweeps.forwards(here.b, here.x, here.residual, here.given);
    if (!finest_.is_coarsest()) {
      restrict_residual(finest_, here.residual, right_side(0));
      cycle(0);
      add_prolonged(finest_, correction(0), here.x);
    }
    finest_.sweeps.backwards(here.b, here.x, here.given);
    for_each_chunk(index_size(order_), kRows, [&](Index, Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        for (int c = 0; c < 3; ++c) z[Offset{3} * order_[i] + c] = here.x[Offset{kNodeStride<3>} * i + c];
      }
    });
  }

  [[nodiscard]] BlockView<kRigidModes> view(const CoarseMatrix& matrix) const {
    const std::span<const Index> same = std::span(identity_).first(matrix.rows());
    return {matrix.offsets, matrix.columns, matrix.values, same, same};
  }

  void make_levels(const BlockView<3>& finest) {
    constexpr Index kDenseSize = 60;
    std::vector<Point> ordered(points_.size());
    for (Index i = 0; i < index_size(order_); ++i) ordered[i] = points_[order_[i]];
    std::vector<double> modes = rigid_modes(ordered);
    finest_ = make_level(finest, Coarsening::plain, modes);
    points_ = std::vector<Point>();
    is_made_ = true;
    if (finest_.is_coarsest()) return;
    update_level(finest, finest_);
    identity_.resize(finest_.coarse.rows());
    std::iota(identity_.begin(), identity_.end(), 0);
    CoarseMatrix* last = &finest_.coarse;
    while (last->rows() > kDenseSize) {
      coarse_vectors_.emplace_back(last->rows());
      coarse_.push_back(make_level(view(*last), Coarsening::smoothed, modes));
      MultigridLevel<kRigidModes>& level = coarse_.back();
      // coarse_ has grown: the level that `last` points into may have moved
      last = coarse_.size() > 1 ? &coarse_[coarse_.size() - 2].coarse : &finest_.coarse;
      update_level(view(*last), level);
      last->values = std::vector<double>();
      if (level.is_coarsest()) return;
      last = &level.coarse;
    }
    coarse_vectors_.emplace_back(last->rows());
    coarsest_inverse_ = dense_inverse(*last);
    last->values = std::vector<double>();
  }

  [[nodiscard]] Vector& right_side(std::size_t level) const { return coarse_vectors_[level].b; }
  [[nodiscard]] Vector& correction(std::size_t level) const { return coarse_vectors_[level].x; }

  /// Sets x ≈ A⁻¹ b on a coarse level.
  void cycle(std::size_t level) const {
    LevelVectors<kRigidModes>& here = coarse_vectors_[level];
    if (level == coarse_.size()) {
      solve_coarsest();
      return;
    }
    const MultigridLevel<kRigidModes>& now = coarse_[level];
    now.sweeps.forwards(here.b, here.x, here.residual, here.given);
    if (!now.is_coarsest()) {
      restrict_residual(now, here.residual, right_side(level + 1));
      cycle(level + 1);
      // one cycle is enough on the last swept level and on the exact level
      if (level + 2 < coarse_.size()) cycle_again(level + 1);
      add_prolonged(now, correction(level + 1), here.x);
    }
    if (level > 0) here.before = here.x;
    now.sweeps.backwards(here.b, here.x, here.given);
  }

  /// Adds a second cycle, applied to the residual of the first.
  void cycle_again(std::size_t level) const {
    LevelVectors<kRigidModes>& here = coarse_vectors_[level];
    coarse_[level].sweeps.residual_after_backwards(here.before, here.x, here.residual);
    std::swap(here.b, here.residual);
    std::swap(here.x, here.first);
    cycle(level);
    std::transform(here.first.begin(), here.first.end(), here.x.begin(), here.x.begin(), std::plus<>());
  }

  void solve_coarsest() const {
    const LevelVectors<kRigidModes>& here = coarse_vectors_.back();
    const Eigen::Index nodes = coarsest_inverse_.rows() / kRigidModes;
    using Strided = Eigen::OuterStride<kNodeStride<kRigidModes>>;
    using Nodes = Eigen::Matrix<float, kRigidModes, Eigen::Dynamic>;
    const Nodes compact = Eigen::Map<const Nodes, 0, Strided>(here.b.data(), kRigidModes, nodes);
    const Eigen::VectorXf solution =
        coarsest_inverse_ * Eigen::Map<const Eigen::VectorXf>(compact.data(), compact.size());
    Eigen::Map<Nodes, 0, Strided>(coarse_vectors_.back().x.data(), kRigidModes, nodes) =
        Eigen::Map<const Nodes>(solution.data(), kRigidModes, nodes);
  }

  std::vector<Point> points_;  ///< kept until the levels are made
  std::vector<Index> order_;   ///< the vertex of each row of the finest level; `number_` is the inverse
  std::vector<Index> number_;
  std::vector<Index> identity_;
  bool is_made_ = false;
  MultigridLevel<3> finest_;
  std::vector<MultigridLevel<kRigidModes>> coarse_;  ///< the levels that are swept
  Eigen::MatrixXf coarsest_inverse_;                 ///< empty if the last level is swept
  mutable LevelVectors<3> finest_vectors_;
  mutable std::vector<LevelVectors<kRigidModes>> coarse_vectors_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_multigrid(const BlockCsr& pattern, std::span<const Point> points) {
  return std::make_unique<Multigrid>(pattern, points);
}

}  // namespace meshorder
