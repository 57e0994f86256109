// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/piece_contents.hpp"

#include "distributed/comm/halo.hpp"
#include "distributed/order/partition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

namespace meshorder::distributed {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(PartOf, CountsVerticesAfterTheLastPartToIt) {
  const std::vector<GlobalIndex> starts{0, 3, 3, 6};
  for (const auto& [vertex, part] : {std::pair{0, 0}, {2, 0}, {3, 2}, {5, 2}, {6, 2}, {90, 2}})
    EXPECT_EQ(part_of(vertex, starts), part) << vertex;
  EXPECT_EQ(part_of_cell(std::span<const GlobalIndex>(std::vector<GlobalIndex>{4, 1}), starts), 2);
}

/// Six vertices in a row, two in each part, and edges between neighbours; a seventh vertex is in no edge.
std::vector<PieceContents> pieces_of_a_line(const Communicator& communicator, bool with_ghosts) {
  const Layout cells = Layout::even(5, communicator.size());
  Rows edges;
  for (GlobalIndex e = cells.begin(communicator.rank()); e < cells.end(communicator.rank()); ++e) {
    edges.entries.insert(edges.entries.end(), {e, e + 1});
    edges.end_row();
  }
  return contents_of_pieces(communicator, 7, cells, edges, {0, 2, 4, 6}, with_ghosts);
}

TEST(PieceContents, AreThePartsAndACellAroundThem) {
  const Communicator communicator;
  std::vector<Index> seen(3, 0);
  for (const PieceContents& piece : pieces_of_a_line(communicator, true)) {
    ++seen[piece.part];
    EXPECT_EQ(piece.own_vertices, piece.part == 2 ? 3 : 2);
    if (piece.part == 0) {
      EXPECT_THAT(piece.vertices, ElementsAre(0, 1, 2));
      EXPECT_THAT(piece.cells, ElementsAre(0, 1));
      EXPECT_THAT(piece.cell_parts, ElementsAre(0, 1));
      EXPECT_THAT(piece.cell_vertices.entries, ElementsAre(0, 1, 1, 2));
    } else if (piece.part == 1) {
      EXPECT_THAT(piece.vertices, ElementsAre(2, 3, 1, 4));
      EXPECT_THAT(piece.cells, ElementsAre(1, 2, 3));
      EXPECT_THAT(piece.cell_parts, ElementsAre(1, 1, 2));
      EXPECT_EQ(piece.own_cells, 2);
      EXPECT_THAT(piece.cell_vertices.entries, ElementsAre(2, 0, 0, 1, 1, 3));
    } else {
      EXPECT_THAT(piece.vertices, ElementsAre(4, 5, 6, 3));
      EXPECT_THAT(piece.cells, ElementsAre(3, 4));
      EXPECT_EQ(piece.ghost_cells(), 0);
      EXPECT_EQ(piece.ghost_vertices(), 1);
    }
  }
  EXPECT_THAT(communicator.sums({seen.begin(), seen.end()}), ElementsAre(1, 1, 1));
}

TEST(PieceContents, LeaveGhostCellsOut) {
  const Communicator communicator;
  for (const PieceContents& piece : pieces_of_a_line(communicator, false)) {
    EXPECT_EQ(piece.ghost_cells(), 0);
    if (piece.part == 0) {
      EXPECT_THAT(piece.vertices, ElementsAre(0, 1));
    } else if (piece.part == 1) {
      EXPECT_THAT(piece.vertices, ElementsAre(2, 3, 1));
    }
  }
}

TEST(PieceContents, GroupGhostCellsByTheirParts) {
  const Communicator communicator;
  // a star: its centre is the first part, and cells of parts take turns
  const Layout cells = Layout::even(4, communicator.size());
  Rows rows;
  for (GlobalIndex c = cells.begin(communicator.rank()); c < cells.end(communicator.rank()); ++c) {
    rows.entries.insert(rows.entries.end(),
                        {0, std::vector<GlobalIndex>{3, 1, 4, 2}[static_cast<std::size_t>(c)]});
    rows.end_row();
  }
  for (const PieceContents& piece : contents_of_pieces(communicator, 5, cells, rows, {0, 1, 3, 5}, true)) {
    if (piece.part != 0) continue;
    EXPECT_THAT(piece.cells, ElementsAre(1, 3, 0, 2));
    EXPECT_THAT(piece.cell_parts, ElementsAre(1, 1, 2, 2));
    EXPECT_THAT(piece.vertices, ElementsAre(0, 1, 2, 3, 4));
  }
}

TEST(Halo, FetchesRowsOfBytes) {
  const Communicator communicator;
  const Layout layout = Layout::even(20, communicator.size());
  std::vector<std::byte> own;
  for (GlobalIndex k = layout.begin(communicator.rank()); k < layout.end(communicator.rank()); ++k)
    own.insert(own.end(), {static_cast<std::byte>(k), static_cast<std::byte>(k + 100), std::byte{7}});
  const std::vector<GlobalIndex> wanted{19, 3, 3, 0};
  const Halo halo(communicator, layout, wanted);
  EXPECT_THAT(halo.fetch_rows(own, 3),
              ElementsAre(std::byte{0}, std::byte{100}, std::byte{7}, std::byte{3}, std::byte{103},
                          std::byte{7}, std::byte{19}, std::byte{119}, std::byte{7}));
  EXPECT_THAT(halo.fetch_rows({}, 0), IsEmpty());
}

}  // namespace
}  // namespace meshorder::distributed
