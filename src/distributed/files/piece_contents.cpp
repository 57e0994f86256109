// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/piece_contents.hpp"

#include "distributed/comm/number_set.hpp"
#include "distributed/order/partition.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>

namespace meshorder::distributed {
namespace {

/// Sets `parts` to the parts of a cell's vertices, ascending, each once; the last one is the cell's part.
void find_parts(std::span<const GlobalIndex> vertices, const std::vector<GlobalIndex>& starts,
                std::vector<Index>& parts) {
  parts.clear();
  for (const GlobalIndex vertex : vertices) parts.push_back(part_of(vertex, starts));
  std::sort(parts.begin(), parts.end());
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
}

/// Cells to be sent to the ranks of their pieces: a row has a cell's number, followed by its vertices.
struct CellsToPieces {
  Rows rows;
  std::vector<Dispatch> dispatches;
};

CellsToPieces sent_to_pieces(const Rows& cell_vertices, GlobalIndex first_cell,
                             const std::vector<GlobalIndex>& starts, const Layout& ranks, bool with_ghosts) {
  CellsToPieces sent;
  sent.rows.entries.reserve(cell_vertices.entries.size() + cell_vertices.offsets.size());
  std::vector<Index> parts;
  for (Offset c = 0; c < cell_vertices.size(); ++c) {
    const auto vertices = cell_vertices[c];
    sent.rows.entries.push_back(first_cell + c);
    sent.rows.entries.insert(sent.rows.entries.end(), vertices.begin(), vertices.end());
    sent.rows.end_row();
    find_parts(vertices, starts, parts);
    if (!with_ghosts) parts = {parts.back()};
    int last_rank = -1;
    for (const Index part : parts) {
      const int rank = ranks.owner(part);
      if (rank != last_rank) sent.dispatches.push_back({rank, c});
      last_rank = rank;
    }
  }
  return sent;
}

/// A cell of a piece.
struct CellOfPiece {
  Index part;  ///< part to which the cell belongs
  Offset row;
};

/// Sorts cells by part, but puts those of `part` first; stable.
void sort_own_first(std::vector<CellOfPiece>& cells, Index part) {
  std::stable_sort(cells.begin(), cells.end(), [&](const CellOfPiece& a, const CellOfPiece& b) {
    if ((a.part == part) != (b.part == part)) return a.part == part;
    return a.part < b.part;
  });
}

/// Returns the piece of a part with these cells; the part's own vertices are begin … end − 1. A row has a
/// cell's number and vertices.
PieceContents piece_of(Index part, GlobalIndex begin, GlobalIndex end, const Rows& rows,
                       const std::vector<CellOfPiece>& cells) {
  PieceContents piece;
  piece.part = part;
  piece.own_vertices = end - begin;
  std::vector<GlobalIndex> others;
  for (const CellOfPiece& cell : cells) {
    const auto row = rows[cell.row];
    piece.cells.push_back(row.front());
    piece.cell_parts.push_back(cell.part);
    piece.own_cells += cell.part == part ? 1 : 0;
    for (const GlobalIndex vertex : row.subspan(1)) {
      if (vertex < begin || vertex >= end) others.push_back(vertex);
    }
  }
  const NumberSet ghosts(others);
  piece.vertices.resize(static_cast<std::size_t>(piece.own_vertices));
  std::iota(piece.vertices.begin(), piece.vertices.end(), begin);
  piece.vertices.insert(piece.vertices.end(), ghosts.numbers().begin(), ghosts.numbers().end());
  for (const CellOfPiece& cell : cells) {
    for (const GlobalIndex vertex : rows[cell.row].subspan(1)) {
      const bool is_own = vertex >= begin && vertex < end;
      piece.cell_vertices.entries.push_back(
          is_own ? vertex - begin : piece.own_vertices + static_cast<GlobalIndex>(ghosts.position(vertex)));
    }
    piece.cell_vertices.end_row();
  }
  return piece;
}

}  // namespace

std::vector<PieceContents> contents_of_pieces(const Communicator& communicator, GlobalIndex vertex_count,
                                              const Layout& cells, const Rows& cell_vertices,
                                              const std::vector<GlobalIndex>& part_starts, bool with_ghosts) {
  const int rank = communicator.rank();
  const auto part_count = static_cast<Index>(part_starts.size()) - 1;
  const Layout ranks = ranks_of_parts(part_count, communicator.size());
  const CellsToPieces sent = communicator.together(
      [&] { return sent_to_pieces(cell_vertices, cells.begin(rank), part_starts, ranks, with_ghosts); });
  // rows arrive in rank order, so that cells ascend
  const Rows rows = send_rows(communicator, sent.rows, sent.dispatches);
  return communicator.together([&] {
    const auto first = static_cast<Index>(ranks.begin(rank));
    const auto own = static_cast<Index>(ranks.size(rank));
    std::vector<std::vector<CellOfPiece>> of_pieces(static_cast<std::size_t>(own));
    std::vector<Index> parts;
    for (Offset row = 0; row < rows.size(); ++row) {
      find_parts(rows[row].subspan(1), part_starts, parts);
      const Index owner = parts.back();
      if (!with_ghosts) parts = {owner};
      for (const Index part : parts) {
        if (part >= first && part < first + own) of_pieces[part - first].push_back({owner, row});
      }
    }
    std::vector<PieceContents> pieces;
    for (Index part = first; part < first + own; ++part) {
      std::vector<CellOfPiece>& of_piece = of_pieces[part - first];
      sort_own_first(of_piece, part);
      const GlobalIndex end =
          part + 1 == part_count ? vertex_count : part_starts[static_cast<std::size_t>(part) + 1];
      pieces.push_back(piece_of(part, part_starts[part], end, rows, of_piece));
      of_piece = {};
    }
    return pieces;
  });
}

}  // namespace meshorder::distributed
