// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "spectral/row_chunks.hpp"

#include "support/sample_graphs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace meshorder {
namespace {

RowChunks chunks_of(const CsrGraph& graph) { return RowChunks(test::combinatorial_laplacian(graph)); }

TEST(RowChunks, NoEdgeJoinsTwoChunksOfAColour) {
  for (const CsrGraph& graph : {test::path(100000), test::grid(500, 100), test::star(50000)}) {
    const RowChunks chunks = chunks_of(graph);
    ASSERT_GT(chunks.count(), 1);
    std::vector<std::size_t> colour_of(chunks.count(), 99);
    for (std::size_t colour = 0; colour < chunks.colours().size(); ++colour) {
      for (const Index chunk : chunks.colours()[colour]) {
        EXPECT_EQ(colour_of[chunk], 99U) << "a chunk has one colour";
        colour_of[chunk] = colour;
      }
    }
    for (Index v = 0; v < graph.size(); ++v) {
      for (const Index u : graph[v]) {
        const Index a = chunks.chunk_of(v);
        const Index b = chunks.chunk_of(u);
        ASSERT_TRUE(a == b || colour_of[a] != colour_of[b]);
      }
    }
  }
}

TEST(RowChunks, TwoColoursDoForABand) { EXPECT_EQ(chunks_of(test::path(100000)).colours().size(), 2U); }

TEST(RowChunks, AreOneOfAnyNumberOfRows) {
  for (const Index rows : {1, 1 << 30, (1 << 30) + 1, kMaxIndex}) {
    EXPECT_EQ(RowChunks::whole(rows).count(), 1) << rows;
    EXPECT_GE(RowChunks::whole(rows).size(), rows);
  }
}

TEST(RowChunks, AreOneWhereTooManyTouch) {
  EXPECT_EQ(chunks_of(test::random_regular(100000, 6, 1)).count(), 1);
  EXPECT_EQ(chunks_of(test::path(100)).count(), 1);
}

TEST(RowChunks, GoOverEveryRowOnceBothWays) {
  const RowChunks chunks = chunks_of(test::grid(500, 100));
  std::vector<int> forwards(50000, 0), backwards(50000, 0), each(50000, 0), pieces(50000, 0);
  chunks.for_each_forwards([&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) ++forwards[v];
  });
  chunks.for_each_backwards([&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) ++backwards[v];
  });
  chunks.for_each([&](Index chunk, Index begin, Index end) {
    for (Index v = begin; v < end; ++v) each[v] += chunks.chunk_of(v) == chunk ? 1 : 9;
  });
  std::vector<Index> rising, falling;
  in_rising_pieces([&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) rising.push_back(v);
  })(7, 30000);
  in_falling_pieces([&](Index begin, Index end) {
    for (Index v = end; v-- > begin;) falling.push_back(v);
  })(7, 30000);
  chunks.for_each_piece([&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) pieces[v] += end - begin <= kRowsOfPiece ? 1 : 9;
  });
  EXPECT_EQ(pieces, std::vector<int>(50000, 1));
  std::vector<Index> ascending(30000 - 7);
  std::iota(ascending.begin(), ascending.end(), 7);
  EXPECT_EQ(rising, ascending);
  EXPECT_TRUE(std::equal(falling.begin(), falling.end(), ascending.rbegin(), ascending.rend()));
  EXPECT_EQ(forwards, std::vector<int>(50000, 1));
  EXPECT_EQ(backwards, forwards);
  EXPECT_EQ(each, forwards);
}

}  // namespace
}  // namespace meshorder
