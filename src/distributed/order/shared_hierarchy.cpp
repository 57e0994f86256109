// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/order/shared_hierarchy.hpp"

#include "distributed/order/shared_problem.hpp"
#include "spectral/aggregation.hpp"
#include "spectral/coarsening.hpp"
#include "spectral/lobpcg.hpp"
#include "spectral/row_chunks.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace meshorder::distributed {
namespace {

/// Makes one Gauss–Seidel sweep over this rank's rows; the values of other ranks stay fixed.
template <int M, class RightSide>
void sweep_forwards(const SharedLevel& level, RightSide b, VectorBlock<M>& x) {
  const Index rows = level.laplacian.size();
  for (Index v = 0; v < rows; ++v) relax_row<M>(level.laplacian, v, b, x);
}

template <int M, class RightSide>
void sweep_backwards(const SharedLevel& level, RightSide b, VectorBlock<M>& x) {
  for (Index v = level.laplacian.size(); v-- > 0;) relax_row<M>(level.laplacian, v, b, x);
}

/// Sweeps forwards and backwards on L x = 0, which smooths x after prolongation.
void smooth(const SharedLevel& level, StartBlock& x) {
  const auto zero = [](Index, int) { return 0.0; };
  fetch_others(level, x);
  sweep_forwards<kStartColumns>(level, zero, x);
  fetch_others(level, x);
  sweep_backwards<kStartColumns>(level, zero, x);
  x.resize(level.rows());
}

}  // namespace

SharedHierarchy::SharedHierarchy(const Communicator& communicator, SharedLevel finest, GlobalIndex few)
    : communicator_(communicator) {
  levels_.push_back(std::move(finest));
  while (coarsen(few)) {
  }
}

/// Makes the next coarser level; returns whether it stays distributed.
bool SharedHierarchy::coarsen(GlobalIndex few) {
  SharedLevel& fine = levels_.back();
  const RowChunks all_rows = RowChunks::whole(fine.laplacian.size());
  Aggregation aggregation =
      communicator_.together([&] { return aggregate(fine.laplacian, all_rows, kStrength, fine.masses); });
  fine.aggregation = aggregation;
  const Layout layout = Layout::of_sizes(communicator_.gathered(GlobalIndex{aggregation.count()}));

  // fetch the aggregates of the neighbours on other ranks
  const std::vector<GlobalIndex> names = communicator_.together([&] {
    std::vector<GlobalIndex> result;
    result.reserve(fine.rows());
    for (const Index aggregate : fine.aggregation.aggregate_of)
      result.push_back(layout.begin(communicator_.rank()) + aggregate);
    return result;
  });
  const std::vector<GlobalIndex> of_others = fine.halo.fetch(names);
  Halo halo(communicator_, layout, of_others);

  SharedLevel coarse{layout, std::move(halo), {}};
  communicator_.together([&] {
    for (const GlobalIndex name : of_others)
      aggregation.aggregate_of.push_back(aggregation.count() +
                                         static_cast<Index>(coarse.halo.position(name)));
    coarse.laplacian = collapsed(fine.laplacian, all_rows, aggregation,
                                 aggregation.count() + index_size(coarse.halo.numbers()));
    coarse.masses.assign(static_cast<std::size_t>(aggregation.count()), 0);
    for (std::size_t v = 0; v < fine.rows(); ++v) {
      const double mass = fine.masses.empty() ? 1 : fine.masses[v];
      coarse.masses[static_cast<std::size_t>(fine.aggregation.aggregate_of[v])] += mass;
    }
  });
  const bool is_worthwhile =
      static_cast<double>(layout.size()) <= kWorthwhile * static_cast<double>(fine.layout.size());
  if (layout.size() > few && is_worthwhile) {
    levels_.push_back(std::move(coarse));
    return true;
  }
  gather(coarse);
  return false;
}

/// Gathers a level at the root, which builds the coarser levels from it.
void SharedHierarchy::gather(const SharedLevel& coarse) {
  gathered_ = coarse.layout;
  communicator_.at_root([&] {
    if (gathered_.size() > kMaxIndex)
      throw TooLarge("more than 2,147,483,647 vertices are left after coarsening; start fewer ranks");
  });
  std::vector<Offset> degrees(coarse.rows());
  std::vector<Index> neighbours;
  communicator_.together([&] {
    const Laplacian& laplacian = coarse.laplacian;
    for (std::size_t v = 0; v < coarse.rows(); ++v)
      degrees[v] = laplacian.offsets[v + 1] - laplacian.offsets[v];
    neighbours.reserve(laplacian.neighbours.size());
    const auto first = static_cast<Index>(gathered_.begin(communicator_.rank()));
    for (const Index column : laplacian.neighbours) {
      const auto other = static_cast<std::size_t>(column) - coarse.rows();
      const bool is_own = static_cast<std::size_t>(column) < coarse.rows();
      neighbours.push_back(is_own ? first + column : static_cast<Index>(coarse.halo.numbers()[other]));
    }
  });
  Laplacian whole;
  degrees = communicator_.gathered_at_root(degrees);
  whole.neighbours = communicator_.gathered_at_root(neighbours);
  whole.weights = communicator_.gathered_at_root(coarse.laplacian.weights);
  whole.diagonal = communicator_.gathered_at_root(coarse.laplacian.diagonal);
  std::vector<double> masses = communicator_.gathered_at_root(coarse.masses);
  communicator_.at_root([&] {
    whole.offsets.resize(degrees.size() + 1);
    std::partial_sum(degrees.begin(), degrees.end(), whole.offsets.begin() + 1);
    bottom_.emplace(std::move(whole), std::move(masses));
  });
}

/// Computes the correction of the gathered level at the root; returns this rank's rows.
template <int M>
VectorBlock<M> SharedHierarchy::corrected_at_root(const VectorBlock<M>& own) {
  VectorBlock<M> b = communicator_.gathered_at_root(own);
  VectorBlock<M> x;
  communicator_.at_root([&] {
    VectorBlock<M> second;
    CycleWorkspace<M> workspace;
    bottom_->two_cycles<M>(0, b, x, second, workspace);
  });
  return communicator_.scattered_from_root(x, gathered_.starts());
}

/// Computes the correction of a level other than the finest, by two cycles; returns this rank's rows.
template <int M>
VectorBlock<M> SharedHierarchy::coarse_correction(std::size_t level, VectorBlock<M> b) {
  if (level == levels_.size()) return corrected_at_root<M>(b);
  const SharedLevel& here = levels_[level];
  VectorBlock<M> x;
  cycle<M>(level, b, x);
  fetch_others(here, x);
  VectorBlock<M> residual(here.rows());
  for (Index v = 0; v < here.laplacian.size(); ++v)
    residual[static_cast<std::size_t>(v)] = residual_of_row<M>(here.laplacian, v, b, x);
  VectorBlock<M> second;
  cycle<M>(level, residual, second);
  x.resize(here.rows());
  for (std::size_t v = 0; v < here.rows(); ++v) {
    for (std::size_t m = 0; m < M; ++m) x[v][m] += second[v][m];
  }
  return x;
}

template <int M>
void SharedHierarchy::cycle(std::size_t level, const VectorBlock<M>& b, VectorBlock<M>& x) {
  const SharedLevel& here = levels_[level];
  const auto entry_of_b = [&](Index v, int m) {
    return b[static_cast<std::size_t>(v)][static_cast<std::size_t>(m)];
  };
  x.assign(here.rows() + here.halo.numbers().size(), std::array<double, M>{});
  sweep_forwards<M>(here, entry_of_b, x);
  fetch_others(here, x);
  const bool is_last = level + 1 == levels_.size();
  const GlobalIndex coarse_rows =
      (is_last ? gathered_ : levels_[level + 1].layout).size(communicator_.rank());
  VectorBlock<M> coarse(static_cast<std::size_t>(coarse_rows), std::array<double, M>{});
  for (Index v = 0; v < here.laplacian.size(); ++v) {
    const auto residual = residual_of_row<M>(here.laplacian, v, b, x);
    auto& sum = coarse[static_cast<std::size_t>(here.aggregation.aggregate_of[static_cast<std::size_t>(v)])];
    for (std::size_t m = 0; m < M; ++m) sum[m] += residual[m];
  }
  coarse = coarse_correction<M>(level + 1, std::move(coarse));
  for (std::size_t v = 0; v < here.rows(); ++v) {
    const auto& correction = coarse[static_cast<std::size_t>(here.aggregation.aggregate_of[v])];
    for (std::size_t m = 0; m < M; ++m) x[v][m] += kOverCorrection * correction[m];
  }
  fetch_others(here, x);
  sweep_backwards<M>(here, entry_of_b, x);
  x.resize(here.rows());
}

StartBlock SharedHierarchy::nested_start(std::uint64_t seed) {
  StartBlock x;
  communicator_.at_root([&] {
    x = meshorder::nested_start(*bottom_, seed, {});
    const bool is_exact = bottom_->levels().size() == 1 && bottom_->has_exact_coarsest();
    if (!is_exact) lobpcg<kStartColumns>(*bottom_, 0, coarse_search({}), x);
  });
  x = communicator_.scattered_from_root(x, gathered_.starts());
  for (std::size_t level = levels_.size(); level-- > 0;) {
    const SharedLevel& here = levels_[level];
    StartBlock finer(here.rows());
    for (std::size_t v = 0; v < here.rows(); ++v)
      finer[v] = x[static_cast<std::size_t>(here.aggregation.aggregate_of[v])];
    x = std::move(finer);
    smooth(here, x);
    if (level > 0) {
      SharedProblem problem(*this, level);
      lobpcg<kStartColumns, 0>(problem, coarse_search({}), x, {});
    }
  }
  return x;
}

template void SharedHierarchy::cycle<1>(std::size_t, const VectorBlock<1>&, VectorBlock<1>&);
template void SharedHierarchy::cycle<2>(std::size_t, const VectorBlock<2>&, VectorBlock<2>&);

}  // namespace meshorder::distributed
