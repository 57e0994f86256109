// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "spectral/aggregation.hpp"

#include <optional>
#include <vector>

namespace meshorder {

/// A sparse matrix by rows; the columns of a row are in no particular order, none twice.
struct SparseRows {
  Index columns_count = 0;
  std::vector<Offset> offsets{0};  ///< rows + 1
  std::vector<Index> columns;
  std::vector<double> values;

  [[nodiscard]] Index rows() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// Aᵀ. O(rows + columns + entries).
SparseRows transposed(const SparseRows& a);

/// The (weighted) Galerkin product Pᵀ L P of the piecewise constant P of an aggregation: the weights between
/// two aggregates added up. O(n + edges), on all threads.
Laplacian collapsed(const Laplacian& fine, const RowChunks& chunks, const Aggregation& aggregation);

/// The same of some rows of a larger graph, whose other vertices are numbered after those of the rows.
///
/// @param aggregation  of the rows, and with `aggregate_of` of the others, too
/// @param columns      aggregates in all; those of the others are numbered after those of the rows
Laplacian collapsed(const Laplacian& fine, const RowChunks& chunks, const Aggregation& aggregation,
                    Index columns);

/// (I − ω D⁻¹ L) P₀ with P₀ piecewise constant and ω = 2/3 (Vaněk, Mandel, Brezina 1996). Rows sum to 1, as
/// those of P₀ do. O(n + edges).
SparseRows smoothed_prolongation(const Laplacian& fine, const Aggregation& aggregation);

/// Pᵀ L P; nothing where it has more entries than `most`, as at a vertex that very many others have for a
/// neighbour. O(multiplications), in the last case O(most + n) for each thread beside the rows that fit.
std::optional<Laplacian> galerkin_product(const Laplacian& fine, const SparseRows& prolongation, Offset most);

}  // namespace meshorder
