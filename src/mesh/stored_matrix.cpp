// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/stored_matrix.hpp"

#include "graph/examine.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <utility>

namespace meshorder {
namespace {

/// Returns the number of entries divided by the number of positions in all b × b blocks that have an entry.
double fill_of_blocks(const EntryPattern& pattern, Index b) {
  std::vector<Index> seen_by(pattern.rows() / b, -1);  // for each block of columns, the last block of rows
  Offset blocks = 0;
  for (Index row = 0; row < pattern.rows(); ++row) {
    for (const Index column : pattern[row]) {
      Index& seen = seen_by[column / b];
      blocks += seen != row / b ? 1 : 0;
      seen = row / b;
    }
  }
  return blocks == 0 ? 0 : static_cast<double>(pattern.entries()) / static_cast<double>(blocks * b * b);
}

}  // namespace

const StoredMatrix* stored_matrix(const Mesh& mesh) {
  return dynamic_cast<const StoredMatrix*>(mesh.format_metadata.get());
}

Mesh matrix_mesh(const GraphView& matrix) {
  const GraphView pattern{.offsets = matrix.offsets, .neighbours = matrix.neighbours, .base = matrix.base};
  const GraphArrays arrays = graph_arrays(pattern);
  if (arrays.neighbours.size() > static_cast<std::size_t>(kMaxIndex)) {
    throw TooLarge("matrix: " + std::to_string(arrays.neighbours.size()) +
                   " entries; at most 2,147,483,647 are possible");
  }
  refuse_faults(pattern, arrays, examine(arrays, false));
  Mesh mesh;
  mesh.points.resize(static_cast<std::size_t>(arrays.size()), {0, 0, 0});
  mesh.cells.reserve(static_cast<Offset>(arrays.neighbours.size()),
                     2 * static_cast<Offset>(arrays.neighbours.size()));
  for (Index row = 0; row < arrays.size(); ++row) {
    for (Offset k = arrays.offsets[row]; k < arrays.offsets[row + 1]; ++k) {
      const std::array entry{row, arrays.neighbours[k]};
      const bool is_diagonal = entry[0] == entry[1];
      mesh.cells.push_back(is_diagonal ? Shape::vertex : Shape::line,
                           std::span(entry).first(is_diagonal ? 1 : 2));
    }
  }
  mesh.format_metadata = std::make_shared<StoredMatrix>();
  return mesh;
}

bool has_places(const Mesh& mesh) {
  return std::any_of(mesh.points.begin(), mesh.points.end(),
                     [&](const Point& point) { return point != mesh.points.front(); });
}

EntryPattern entry_pattern(const Mesh& mesh) {
  const StoredMatrix* const stored = stored_matrix(mesh);
  const bool is_half = stored != nullptr && stored->is_half;
  const auto for_entries = [&](auto take) {
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      const std::span<const Index> cell = mesh.cells[c];
      take(cell.front(), cell.back());
      if (is_half && cell.front() != cell.back()) take(cell.back(), cell.front());
    }
  };
  EntryPattern pattern;
  pattern.starts.assign(mesh.points.size() + 1, 0);
  for_entries([&](Index row, Index /*column*/) { ++pattern.starts[row + 1]; });
  std::partial_sum(pattern.starts.begin(), pattern.starts.end(), pattern.starts.begin());
  pattern.columns.resize(pattern.starts.back());
  std::vector<Offset> next(pattern.starts.begin(), pattern.starts.end() - 1);
  for_entries([&](Index row, Index column) { pattern.columns[next[row]++] = column; });
  tidy_rows(pattern.starts, pattern.columns, true);
  return pattern;
}

bool is_symmetric(const EntryPattern& pattern) {
  // the rows are visited in ascending order: in a symmetric pattern, the rows with an entry in column c are
  // visited in the order of the entries of row c
  std::vector<Offset> next(pattern.starts.begin(), pattern.starts.end() - 1);
  for (Index row = 0; row < pattern.rows(); ++row) {
    for (const Index column : pattern[row]) {
      const Offset at = next[column]++;
      if (at >= pattern.starts[column + 1] || pattern.columns[at] != row) return false;
    }
  }
  return true;
}

EntryPattern moved(const Permutation& rows, const EntryPattern& pattern) {
  // rows and columns move like the vertices of a graph
  CsrGraph graph = renumbered(GraphRef(pattern.starts, pattern.columns), rows.old_to_new());
  return {std::move(graph.offsets), std::move(graph.neighbours)};
}

PatternFacts facts_of(const EntryPattern& pattern) {
  constexpr Index kLargestBlock = 8;
  PatternFacts facts;
  for (Index row = 0; row < pattern.rows(); ++row) {
    const std::span<const Index> columns = pattern[row];
    facts.most_in_row = std::max(facts.most_in_row, index_size(columns));
    facts.missing_diagonal += std::binary_search(columns.begin(), columns.end(), row) ? 0 : 1;
    for (const Index column : columns) {
      if (column == row) continue;
      const auto bin = std::bit_width(static_cast<std::uint32_t>(std::abs(column - row))) - std::size_t{1};
      if (bin >= facts.histogram_log2.size()) facts.histogram_log2.resize(bin + 1, 0);
      ++facts.histogram_log2[bin];
    }
  }
  facts.is_symmetric = is_symmetric(pattern);
  for (Index b = kLargestBlock; b > 1 && facts.block == 1; --b) {
    if (pattern.rows() % b != 0) continue;
    const double fill = fill_of_blocks(pattern, b);
    if (fill < kFullBlocks) continue;
    facts.block = b;
    facts.block_fill = fill;
  }
  return facts;
}

}  // namespace meshorder
