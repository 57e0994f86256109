// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/reorder.hpp"

#include "mesh/cells.hpp"
#include "mesh/graphs.hpp"
#include "ordering/order_cells.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace meshorder {
namespace {

void expect_everything_moves(const Mesh& before) {
  Mesh after = before;
  const Permutation vertices = test::shuffled(before.vertex_count(), 7);
  const Permutation cells = test::shuffled_cells(before, 8);
  apply_reordering(after, vertices, cells);
  check_mesh(after);
  const auto temperature = [](const Mesh& mesh, Association association) -> const std::vector<double>& {
    return std::get<std::vector<double>>(find_array(mesh, "temperature", association)->values);
  };
  for (Index v = 0; v < before.vertex_count(); ++v) {
    const Index w = vertices.old_to_new()[v];
    EXPECT_EQ(after.points[w], before.points[v]);
    EXPECT_EQ(temperature(after, Association::vertices)[w], temperature(before, Association::vertices)[v]);
  }
  for (Index c = 0; c < before.cell_count(); ++c) {
    const Index d = cells.old_to_new()[c];
    EXPECT_EQ(after.cells.shapes[d], before.cells.shapes[c]);
    ASSERT_EQ(after.cells.vertex_count(d), before.cells.vertex_count(c));
    for (int k = 0; k < before.cells.vertex_count(c); ++k) {
      EXPECT_EQ(after.cells[d][k], vertices.old_to_new()[before.cells[c][k]]);
    }
    EXPECT_EQ(temperature(after, Association::cells)[d], temperature(before, Association::cells)[c]);
  }
  for (std::size_t s = 0; s < before.sets.size(); ++s) {
    const auto map = (before.sets[s].association == Association::vertices ? vertices : cells).old_to_new();
    EXPECT_EQ(after.sets[s].members[0], map[before.sets[s].members[0]]);
  }
}

TEST(Reorder, MovesEverythingWithItsVerticesAndCells) { expect_everything_moves(test::mixed_mesh()); }

TEST(Reorder, MovesEverythingOfAMeshThatSeveralThreadsShare) {
  expect_everything_moves(test::tetrahedral_bar(20000));
}

TEST(Reorder, ThereAndBackIsTheSameMesh) {
  Mesh mesh = test::mixed_mesh();
  mesh.cell_blocks = {0, 10, 20};
  const Mesh before = mesh;
  const Permutation vertices = test::shuffled(mesh.vertex_count(), 1);
  const Permutation cells = test::shuffled_cells(mesh, 2);
  apply_reordering(mesh, vertices, cells);
  EXPECT_NE(mesh.cells, before.cells);
  apply_reordering(mesh, vertices.inverse(), cells.inverse());
  test::expect_same(mesh, before);
}

TEST(Reorder, RowsOfPartialArraysFollow) {
  Mesh mesh = test::tetrahedral_bar(2);
  mesh.data.push_back({"partial", Association::vertices, 1, std::vector<double>{0.5, 0.25}, {3, 5}, {}});
  std::vector<Index> reversed(mesh.points.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) reversed[v] = mesh.vertex_count() - 1 - v;
  apply_reordering(mesh, Permutation::from_old_to_new(reversed), Permutation::identity(mesh.cell_count()));
  EXPECT_EQ(mesh.data.back().indices, (std::vector<Index>{8, 6}));
}

TEST(Reorder, IdsRunInTheNewOrder) {
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.vertex_ids = {40, 10, 20, 30, 5, 60, 70, 80};
  mesh.cell_ids = {3, 1, 2, 9, 8, 7};
  mesh.cell_blocks = {0, 3};
  apply_reordering(mesh, test::shuffled(8, 3), test::shuffled_cells(mesh, 4));
  EXPECT_EQ(mesh.vertex_ids, (std::vector<std::int64_t>{5, 10, 20, 30, 40, 60, 70, 80}));
  EXPECT_EQ(mesh.cell_ids, (std::vector<std::int64_t>{1, 2, 3, 7, 8, 9}));
}

TEST(Reorder, RefusesToMoveACellOutOfItsBlock) {
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.cell_blocks = {0, 3};
  const Mesh before = mesh;
  const auto swap_blocks = Permutation::from_old_to_new({3, 1, 2, 0, 4, 5});
  EXPECT_THROW(apply_reordering(mesh, Permutation::identity(8), swap_blocks), InvalidArgument);
  EXPECT_THROW(apply_reordering(mesh, Permutation::identity(7), Permutation::identity(6)), InvalidArgument);
  test::expect_same(mesh, before);
}

TEST(PermutationWithinBlocks, KeepsTheGivenOrderInEachBlock) {
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.cell_blocks = {0, 2};
  const auto p = permutation_within_classes(slot_classes(cell_arrays(mesh)), {5, 4, 3, 2, 1, 0});
  EXPECT_THAT(p.new_to_old(), testing::ElementsAre(1, 0, 5, 4, 3, 2));
}

TEST(GroupCellsByType, PutsTypesTogetherHighestDimensionFirst) {
  Mesh mesh = test::mixed_mesh();
  const Mesh before = mesh;
  const Permutation order = group_cells_by_type(mesh).value();
  check_mesh(mesh);
  for (Index c = 1; c < mesh.cell_count(); ++c) {
    EXPECT_GE(dimension(mesh.cells.shapes[c - 1]), dimension(mesh.cells.shapes[c]));
  }
  EXPECT_EQ(mesh.cell_blocks.size(), 18U);
  mesh.cell_blocks.clear();
  apply_reordering(mesh, Permutation::identity(mesh.vertex_count()),
                   permutation_within_classes(slot_classes(cell_arrays(mesh)),
                                              test::shuffled(mesh.cell_count(), 1).new_to_old()));
  EXPECT_EQ(order.size(), before.cell_count());
}

TEST(DegenerateCells, AreThoseThatNameAVertexTwice) {
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.cells[2][3] = mesh.cells[2][0];
  EXPECT_EQ(degenerate_cells(mesh.cells), std::vector<Index>{2});
}

TEST(DegenerateCells, AreFoundByAnyTwoOfTheirVertices) {
  for (std::size_t first = 0; first < 4; ++first) {
    for (std::size_t second = first + 1; second < 4; ++second) {
      Mesh mesh = test::tetrahedral_bar(1);
      mesh.cells[1][first] = mesh.cells[1][second];
      EXPECT_EQ(degenerate_cells(mesh.cells), std::vector<Index>{1});
    }
  }
}

TEST(DegenerateCells, RiseWhenSeveralThreadsFindThem) {
  Mesh mesh = test::tetrahedral_bar(30000);
  const std::vector<Index> wanted{0, 65535, 65536, 150000};
  for (const Index c : wanted) mesh.cells[c][1] = mesh.cells[c][2];
  EXPECT_EQ(degenerate_cells(mesh.cells), wanted);
}

}  // namespace
}  // namespace meshorder
