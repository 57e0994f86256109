// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/permutation.hpp>
#include <meshorder/view.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The facts that readers of matrices and graphs attach to a mesh. The vertices of the mesh are the rows of a
/// square matrix; its lines, from row to column, and its vertex cells are the stored entries.
struct StoredMatrix : FormatMetadata {
  bool is_graph = false;           ///< a graph of vertices and edges, without entries on the diagonal
  bool is_half = false;            ///< each line represents two entries, (i, j) and (j, i)
  std::string_view field = {};     ///< such as "real", the word in the file; empty for a graph
  std::string_view symmetry = {};  ///< such as "general", the word in the file; empty for a graph

  [[nodiscard]] std::vector<std::string> contents() const override { return {}; }
};

/// Returns the facts that the reader attached to the matrix or graph; null for other meshes. Valid as long as
/// `mesh.format_metadata`.
const StoredMatrix* stored_matrix(const Mesh& mesh);

/// Returns the mesh that the reader of a matrix file would make of this matrix: rows at the origin, entries
/// in their order. Throws as `check`, but not for asymmetry; TooLarge also for 2³¹ entries or more. O(n +
/// entries).
Mesh matrix_mesh(const GraphView& matrix);

/// Returns whether any two points of a mesh differ. The points of a matrix are all 0 unless given separately.
bool has_places(const Mesh& mesh);

/// The positions of all entries of a matrix, even if the file stores only one half. Row i has entries in the
/// columns `columns[starts[i]] … columns[starts[i + 1] − 1]`, ascending, each once.
struct EntryPattern {
  std::vector<Offset> starts{0};  ///< rows + 1
  std::vector<Index> columns;

  [[nodiscard]] Index rows() const noexcept { return static_cast<Index>(starts.size() - 1); }
  [[nodiscard]] Offset entries() const noexcept { return static_cast<Offset>(columns.size()); }
  [[nodiscard]] std::span<const Index> operator[](Index row) const {
    return {columns.data() + starts[row], columns.data() + starts[row + 1]};
  }
  bool operator==(const EntryPattern&) const = default;
};

/// Returns the pattern of the matrix that a mesh represents. Without a StoredMatrix, each cell is an entry,
/// from its first to its last vertex. O(entries · log row length).
EntryPattern entry_pattern(const Mesh& mesh);

/// Returns whether the pattern has an entry (j, i) for each entry (i, j). O(entries).
bool is_symmetric(const EntryPattern& pattern);

/// Returns the pattern of P A Pᵀ: row and column i become `rows.old_to_new()[i]`. O(entries · log row
/// length).
EntryPattern moved(const Permutation& rows, const EntryPattern& pattern);

/// Facts about the pattern of a matrix.
struct PatternFacts {
  Index most_in_row = 0;
  bool is_symmetric = true;
  Index missing_diagonal = 0;  ///< rows without an entry on the diagonal
  /// Size of blocks: the largest b of 2 … 8 that divides the number of rows and for which entries fill at
  /// least the share `kFullBlocks` of all b × b blocks that have an entry; 1 if there is no such b.
  int block = 1;
  double block_fill = 0;  ///< share of the positions in these blocks that hold an entry; 0 if `block` is 1
  std::vector<Offset> histogram_log2 = {};  ///< entry k: number of entries at 2ᵏ … 2ᵏ⁺¹ − 1 off the diagonal
};
inline constexpr double kFullBlocks = 0.8;

/// Returns the facts of a pattern. O(entries).
PatternFacts facts_of(const EntryPattern& pattern);

}  // namespace meshorder
