// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/linear/multigrid/block_galerkin.hpp"
#include "lab/linear/multigrid/block_sweeps.hpp"

#include <vector>

namespace meshorder {

/// One level of a multigrid hierarchy with R unknowns a node, and the transfer to the next coarser level.
template <int R>
struct MultigridLevel {
  BlockSweeps<R> sweeps;
  Prolongation<R> prolongation;  ///< from the next level; without columns on the coarsest level
  Prolongation<R> tentative;     ///< the prolongation before smoothing; empty if it stays plain
  double smoothing = 0;          ///< ω of the smoothed prolongation
  ColumnBlocks transposed;
  CoarseMatrix coarse;  ///< the next level's operator; has values only during an update

  [[nodiscard]] bool is_coarsest() const noexcept { return prolongation.columns_count == 0; }
  [[nodiscard]] std::size_t bytes() const;
};

/// Whether to smooth the prolongation of a level.
enum class Coarsening : std::uint8_t { plain, smoothed };

/// Makes the level of a matrix and the transfer to the next level; aggregates nodes by the norms of their
/// blocks. `modes` holds R×6 numbers a node, in the order of the view, and becomes the modes of the coarse
/// nodes. If coarsening would keep more than 80 % of the nodes, the level is the coarsest.
template <int R>
MultigridLevel<R> make_level(const BlockView<R>& matrix, Coarsening coarsening, std::vector<double>& modes);

/// Computes the values of the sweeps, prolongation and `coarse` from a matrix of the same pattern.
template <int R>
void update_level(const BlockView<R>& matrix, MultigridLevel<R>& level);

/// Computes result = Pᵀ residual.
template <int R>
void restrict_residual(const MultigridLevel<R>& level, const AlignedVector<float>& residual,
                       AlignedVector<float>& result);

/// Adds P correction to x.
template <int R>
void add_prolonged(const MultigridLevel<R>& level, const AlignedVector<float>& correction,
                   AlignedVector<float>& x);

}  // namespace meshorder
