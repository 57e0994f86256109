// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "payoff/elastic.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace meshorder {
namespace {

TEST(BlockCsr, FindsEveryBlockAndNoOther) {
  BlockCsr matrix;
  for (const std::vector<Index>& row :
       {std::vector<Index>{}, {0}, {1, 4}, {0, 2, 3}, {0, 1, 3, 4, 5, 8, 9}}) {
    matrix.columns.insert(matrix.columns.end(), row.begin(), row.end());
    matrix.offsets.push_back(index_size(matrix.columns));
  }
  for (Index row = 0; row < matrix.size(); ++row) {
    for (Index column = 0; column < 12; ++column) {
      const auto begin = matrix.columns.begin() + matrix.offsets[row];
      const auto end = matrix.columns.begin() + matrix.offsets[row + 1];
      const auto found = std::find(begin, end, column);
      EXPECT_EQ(matrix.find(row, column), found == end ? -1 : found - matrix.columns.begin())
          << "row " << row << ", column " << column;
    }
  }
}

TEST(AssemblyMap, FindsTheBlocksOfEverySimplex) {
  for (const Index count : {9, 9001}) {  // threads share more than 4096
    const test::Patch patch = test::deformed_patch(3, count);
    const BlockCsr matrix = zero_block_csr(test::graph_of(patch));
    const AssemblyMap map = assembly_map(patch.rest, matrix);
    ASSERT_EQ(map.blocks.size(), std::size_t{16} * count);
    for (Index s = 0; s < count; ++s) {
      for (Index a = 0; a < 4; ++a) {
        for (Index b = 0; b < 4; ++b) {
          EXPECT_EQ(map.blocks[16 * s + 4 * a + b],
                    matrix.find(patch.simplices.vertices[4 * s + a], patch.simplices.vertices[4 * s + b]));
        }
      }
    }
  }
}

TEST(AssemblyMap, RefusesAMatrixWithoutTheBlocks) {
  const test::Patch patch = test::deformed_patch(3, 9);
  const BlockCsr diagonal = zero_block_csr(graph_from_edges(12, {}));
  EXPECT_THROW(assembly_map(patch.rest, diagonal), InvalidArgument);
}

TEST(AssemblyMap, NamesTheFirstBlockThatTheMatrixLacks) {
  constexpr Index kSimplices = 20'000;
  const test::Patch patch = test::deformed_patch(3, kSimplices);
  const CsrGraph graph = test::graph_of(patch);
  std::vector<Edge> edges;
  for (Index v = 0; v < graph.size(); ++v) {
    for (const Index u : graph[v]) {
      if (v < u && u < kSimplices / 2) edges.push_back({v, u});
    }
  }
  const BlockCsr matrix = zero_block_csr(graph_from_edges(graph.size(), edges));
  Index first = -1;
  Index a = 0;
  Index b = 0;
  for (Index s = 0; s < kSimplices && first < 0; ++s) {
    for (Index pair = 0; pair < 16 && first < 0; ++pair) {
      a = patch.rest.vertex(s, pair / 4);
      b = patch.rest.vertex(s, pair % 4);
      if (matrix.find(a, b) < 0) first = s;
    }
  }
  ASSERT_GT(first, 4096);
  for (int run = 0; run < 5; ++run) {
    try {
      (void)assembly_map(patch.rest, matrix);
      ADD_FAILURE() << "no error";
    } catch (const InvalidArgument& error) {
      EXPECT_EQ(
          std::string(error.what()),
          fmt::format("assembly: the matrix has no block for the vertices {} and {} of an element", a, b));
    }
  }
}

class ElasticShares : public testing::TestWithParam<test::Case> {};
INSTANTIATE_TEST_SUITE_P(OfAll, ElasticShares,
                         testing::Values(test::Case{MaterialModel::corotational, Tangent::exact},
                                         test::Case{MaterialModel::corotational, Tangent::approximate},
                                         test::Case{MaterialModel::stvk, Tangent::exact},
                                         test::Case{MaterialModel::stvk, Tangent::exact, 2},
                                         test::Case{MaterialModel::stvk, Tangent::exact, 1},
                                         test::Case{MaterialModel::neo_hookean, Tangent::exact}),
                         test::case_name);

TEST_P(ElasticShares, AddTheSameBitsHoweverManyThereAre) {
  const test::Patch patch = test::deformed_patch(GetParam().dimension, 101);
  const Elasticity elasticity = test::elasticity_of(GetParam());
  const AlignedVector<double> forces = test::forces_of(patch, elasticity, patch.positions);
  const BlockCsr serial = test::stiffness_of(patch, elasticity, patch.positions);
  const AssemblyMap map = assembly_map(patch.rest, serial);
  for (const Index parts : {1, 2, 3, 7}) {
    SCOPED_TRACE(parts);
    const std::vector<Index> bounds = balanced_ranges(serial.offsets, parts);
    const std::vector<OwnedBatches> shares =
        owned_batches(patch.rest.vertices, patch.rest.dimension + 1, bounds);
    BlockCsr matrix = serial;
    std::vector<OwnedBlocks> blocks;
    for (Index part = 0; part < parts; ++part) {
      blocks.push_back(owned_blocks(patch.rest, map, matrix, shares[part], part));
    }
    matrix.values.assign(9 * static_cast<std::size_t>(blocks.back().room), 0.0);
    AlignedVector<double> shared = padded_zeros(shares.back().room);
    const Stiffness stiffness{map, matrix};
    for_each_part(parts, [&](Index part) {
      add_elasticity(patch.rest, elasticity, patch.positions, shared, &stiffness, shares[part], blocks[part]);
    });
    shared.resize(forces.size());
    matrix.values.resize(serial.values.size());
    EXPECT_EQ(shared, forces);
    EXPECT_EQ(matrix.values, serial.values);
  }
}

TEST(Shares, RefuseAMatrixOrForcesWithoutRoom) {
  const test::Patch patch = test::deformed_patch(3, 9);
  const Elasticity elasticity;
  BlockCsr matrix = zero_block_csr(test::graph_of(patch));
  const AssemblyMap map = assembly_map(patch.rest, matrix);
  const auto shares = owned_batches(patch.rest.vertices, 4, std::vector<Index>{0, 6, 12});
  const OwnedBlocks blocks = owned_blocks(patch.rest, map, matrix, shares[0], 0);
  const Stiffness stiffness{map, matrix};
  AlignedVector<double> forces = padded_zeros(shares[0].room);
  EXPECT_THROW(add_elasticity(patch.rest, elasticity, patch.positions, forces, &stiffness, shares[0], blocks),
               InvalidArgument);
  matrix.values.resize(9 * static_cast<std::size_t>(blocks.room));
  EXPECT_NO_THROW(
      add_elasticity(patch.rest, elasticity, patch.positions, forces, &stiffness, shares[0], blocks));
  forces.pop_back();
  EXPECT_THROW(add_elasticity(patch.rest, elasticity, patch.positions, forces, &stiffness, shares[0], blocks),
               InvalidArgument);
}

}  // namespace
}  // namespace meshorder
