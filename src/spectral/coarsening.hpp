// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/index.hpp"
#include "spectral/aggregation.hpp"

#include <optional>
#include <vector>

namespace meshorder {

/// A sparse matrix by rows. The columns of a row are in no particular order; no column occurs twice in a row.
struct SparseRows {
  Index columns_count = 0;
  std::vector<Offset> offsets{0};  ///< rows + 1
  std::vector<Index> columns;
  std::vector<double> values;

  [[nodiscard]] Index rows() const noexcept { return static_cast<Index>(offsets.size() - 1); }
};

/// Returns Aᵀ. O(rows + columns + entries).
SparseRows transposed(const SparseRows& a);

/// Returns the Galerkin product Pᵀ L P for the piecewise constant P of an aggregation: the weight of an edge
/// is the sum of all weights between its two aggregates. O(n + edges), on all threads.
Laplacian collapsed(const Laplacian& fine, const RowChunks& chunks, const Aggregation& aggregation);

/// The same for some rows of a larger graph. The vertices of these rows have the first numbers.
///
/// @param aggregation  aggregates of the rows; `aggregate_of` also has entries for the other vertices
/// @param columns      number of all aggregates; aggregates of the rows come before those of other vertices
Laplacian collapsed(const Laplacian& fine, const RowChunks& chunks, const Aggregation& aggregation,
                    Index columns);

/// Returns (I − ω D⁻¹ L) P₀ with P₀ piecewise constant and ω = 2/3 (Vaněk, Mandel, Brezina 1996). Rows sum to
/// 1, like those of P₀. O(n + edges).
SparseRows smoothed_prolongation(const Laplacian& fine, const Aggregation& aggregation);

/// Returns Pᵀ L P; nothing if it has more entries than `most`, which can happen if a vertex has very many
/// neighbours. O(multiplications) time. Memory: O(most) entries and, for each thread, O(n), even if there is
/// no result.
std::optional<Laplacian> galerkin_product(const Laplacian& fine, const SparseRows& prolongation, Offset most);

}  // namespace meshorder
