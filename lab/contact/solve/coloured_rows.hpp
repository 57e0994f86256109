// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"
#include "kernels/aligned.hpp"
#include "lab/linear/cholesky/sparse_matrix.hpp"

#include <span>
#include <vector>

namespace meshorder {

/// The rows of a symmetric matrix sorted by colour, no two of one colour being joined: rows of a colour can
/// be relaxed at the same time, by any number of threads to the same bits. Colours are first fit along the
/// vertices; within one, rows rise. Positions have kPaddedStride numbers for each vertex, the last of them 0.
template <class Real>
class ColouredRows {
 public:
  /// The matrix needs a positive diagonal: throws InvalidArgument where it has none. O(entries).
  explicit ColouredRows(const SparseMatrix& matrix);

  [[nodiscard]] Index size() const noexcept { return index_size(vertices_); }
  /// The places at which colours begin, and n.
  [[nodiscard]] std::span<const Index> colours() const noexcept { return colours_; }

  static constexpr Index kParts = 16;  ///< enough for the cores of a desktop
  /// The kParts + 1 places that bound the parts of a colour: as many vertices each, the same in all colours,
  /// so that a thread that keeps its part meets the same positions in every colour.
  [[nodiscard]] std::span<const Index> parts(Index colour) const {
    return {parts_.data() + Offset{kParts + 1} * colour, kParts + 1};
  }
  /// The place of a vertex among the rows.
  [[nodiscard]] Index place_of(Index vertex) const { return places_[vertex]; }
  [[nodiscard]] double diagonal(Index vertex) const {
    return static_cast<double>(diagonal_[places_[vertex]]);
  }

  /// x_v ← x_v + relaxation (b − A x)_v / a_vv for the rows at places begin … end − 1, which must be of one
  /// colour; returns the sum of a_vv times the squares of the changes.
  [[nodiscard]] double relax(Index begin, Index end, Real relaxation, std::span<const Real> b,
                             std::span<Real> x) const;

  /// (b − A x)_v
  [[nodiscard]] Point residual(Index vertex, std::span<const Real> b, std::span<const Real> x) const;

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<Index> colours_;
  std::vector<Index> parts_;     ///< of each colour
  std::vector<Index> vertices_;  ///< of each place
  std::vector<Index> places_;
  std::vector<Offset> offsets_{0};
  AlignedVector<Index> columns_;
  AlignedVector<Real> values_;
  AlignedVector<Real> diagonal_;  ///< of each place
};

}  // namespace meshorder
