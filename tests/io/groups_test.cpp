// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/groups.hpp"

#include "mesh/reorder.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// A scrambled bar of cubes with faces at its side. "part" is 30, −4 or 7 for runs of three cubes, and −100
/// for every face.
Mesh bar_of_parts() {
  Mesh mesh = test::tetrahedral_bar(9);
  mesh.data.clear();
  mesh.sets.clear();
  std::vector<std::int64_t> parts;
  parts.reserve(mesh.cells.shapes.size() + 9);
  for (Index c = 0; c < mesh.cell_count(); ++c) parts.push_back(std::array{30, -4, 7}[c / 6 / 3]);
  for (Index i = 0; i < 9; ++i) {
    mesh.cells.push_back(Shape::triangle, std::vector<Index>{4 * i, 4 * i + 4, 4 * i + 5});
    parts.push_back(-100);
  }
  mesh.points.resize(mesh.points.size() + 3, Point{});  // unused
  mesh.data.push_back({"part", Association::cells, 1, parts, {}, {}});
  mesh.cell_blocks.clear();
  apply_reordering(mesh, test::shuffled(mesh.vertex_count(), 1), test::shuffled_cells(mesh, 2));
  return mesh;
}

const std::vector<std::int64_t>& values_of(const Mesh& mesh, std::string_view name, Association association) {
  return std::get<std::vector<std::int64_t>>(find_array(mesh, name, association)->values);
}

/// The smallest part among the tetrahedra at a vertex; the largest integer if it has no tetrahedra.
std::int64_t smallest_part_at(const Mesh& mesh, Index vertex) {
  std::int64_t smallest = std::numeric_limits<std::int64_t>::max();
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto vertices = mesh.cells[c];
    if (mesh.cells.shapes[c] != Shape::tetrahedron) continue;
    if (std::find(vertices.begin(), vertices.end(), vertex) == vertices.end()) continue;
    smallest = std::min(smallest, values_of(mesh, "part", Association::cells)[c]);
  }
  return smallest;
}

ReorderOptions grouped(std::string name, std::string vertices = "rcm") {
  return {.methods = {.vertices = std::move(vertices)}, .group_by = std::move(name)};
}

std::string refusal(const Mesh& mesh, std::string_view name) {
  try {
    grouping_by(mesh, name);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(GroupBy, KeepsCellsOfOneValueTogetherByRisingValue) {
  for (const char* elements : {"lexmax", "hilbert", "original", "scrambled"}) {
    Mesh mesh = bar_of_parts();
    ReorderOptions options = grouped("part");
    options.methods.elements = elements;
    reorder(mesh, options);
    std::vector<std::int64_t> of_tetrahedra;
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      if (mesh.cells.shapes[c] != Shape::tetrahedron) continue;
      of_tetrahedra.push_back(values_of(mesh, "part", Association::cells)[c]);
    }
    EXPECT_TRUE(std::is_sorted(of_tetrahedra.begin(), of_tetrahedra.end())) << elements;
  }
}

TEST(GroupBy, PutsEachVertexWithTheSmallestValueAmongItsElements) {
  for (const char* vertices : {"rcm", "fiedler", "hilbert", "original", "auto"}) {
    Mesh mesh = bar_of_parts();
    const std::vector<GroupSize> sizes = group_sizes(grouping_by(mesh, "part"));
    reorder(mesh, grouped("part", vertices));
    std::vector<std::int64_t> at_vertices;
    at_vertices.reserve(mesh.points.size());
    for (Index v = 0; v < mesh.vertex_count(); ++v) at_vertices.push_back(smallest_part_at(mesh, v));
    EXPECT_TRUE(std::is_sorted(at_vertices.begin(), at_vertices.end())) << vertices;
    // −4 takes both interfaces: 4 layers of 4 vertices; the others have 3 layers; unused vertices come last
    ASSERT_EQ(sizes.size(), 5U);
    const std::vector<std::pair<Index, Index>> expected{{0, 9}, {16, 18}, {12, 18}, {12, 18}, {3, 0}};
    for (std::size_t g = 0; g < sizes.size(); ++g) {
      EXPECT_EQ(std::pair(sizes[g].vertices, sizes[g].cells), expected[g]) << g;
      EXPECT_EQ(sizes[g].value.has_value(), g < 4);
    }
  }
}

TEST(GroupBy, OrdersElementsWithinTheirGroupsByTheMethod) {
  Mesh mesh = bar_of_parts();
  reorder(mesh, grouped("part"));
  std::vector<std::pair<std::int64_t, std::vector<Index>>> keys;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (mesh.cells.shapes[c] != Shape::tetrahedron) continue;
    std::vector<Index> falling(mesh.cells[c].begin(), mesh.cells[c].end());
    std::sort(falling.rbegin(), falling.rend());
    keys.emplace_back(values_of(mesh, "part", Association::cells)[c], falling);
  }
  EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
}

TEST(GroupBy, StaysWithinBlocks) {
  Mesh mesh = bar_of_parts();
  mesh.cell_blocks = {0, 20};
  reorder(mesh, grouped("part"));
  for (const auto& [begin, end] : {std::pair(0, 20), std::pair(20, mesh.cell_count())}) {
    std::vector<std::int64_t> of_block;
    for (Index c = begin; c < end; ++c) {
      if (mesh.cells.shapes[c] != Shape::tetrahedron) continue;
      of_block.push_back(values_of(mesh, "part", Association::cells)[c]);
    }
    EXPECT_TRUE(std::is_sorted(of_block.begin(), of_block.end()));
  }
}

TEST(GroupBy, AnArrayOnVerticesGroupsThemAndLeavesElementsToTheirMethod) {
  Mesh mesh = bar_of_parts();
  std::vector<std::int64_t> zones;
  zones.reserve(mesh.points.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) zones.push_back(v % 3);
  mesh.data.push_back({"zone", Association::vertices, 1, zones, {}, {}});
  EXPECT_TRUE(grouping_by(mesh, "zone").of_cells.empty());
  reorder(mesh, grouped("zone"));
  const std::vector<std::int64_t>& after = values_of(mesh, "zone", Association::vertices);
  EXPECT_TRUE(std::is_sorted(after.begin(), after.end()));
  std::vector<std::vector<Index>> tuples;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    if (mesh.cells.shapes[c] != Shape::tetrahedron) continue;
    tuples.emplace_back(mesh.cells[c].begin(), mesh.cells[c].end());
    std::sort(tuples.back().rbegin(), tuples.back().rend());
  }
  EXPECT_TRUE(std::is_sorted(tuples.begin(), tuples.end()));
}

TEST(GroupBy, PutsWhatHasNoValueLast) {
  Mesh mesh = test::tetrahedral_bar(2);
  mesh.data = {{"some", Association::cells, 1, std::vector<std::int32_t>{5, 5, 3}, {4, 7, 11}, {}}};
  const Grouping grouping = grouping_by(mesh, "some");
  EXPECT_EQ(grouping.values, (std::vector<std::int64_t>{3, 5}));
  EXPECT_EQ(grouping.of_cells, (std::vector<Index>{2, 2, 2, 2, 1, 2, 2, 1, 2, 2, 2, 0}));
  reorder(mesh, grouped("some"));
  const auto& rows = mesh.data[0].indices;
  EXPECT_EQ(std::vector<Index>(rows.begin() + 2, rows.end()), std::vector<Index>{0});
  EXPECT_LT(std::max(rows[0], rows[1]), 3);
  EXPECT_EQ(group_sizes(grouping).back().value, std::nullopt);
}

TEST(GroupBy, TakesEveryTypeThatHoldsWholeNumbers) {
  Mesh mesh = test::tetrahedral_bar(1);
  const std::vector<Values> types{
      std::vector<std::int8_t>{2, -1, 2, -1, 2, 2},  std::vector<std::uint8_t>{9, 1, 9, 1, 9, 9},
      std::vector<std::int32_t>{2, -1, 2, -1, 2, 2}, std::vector<std::uint64_t>{9, 1, 9, 1, 9, 9},
      std::vector<float>{2.0F, -1.0F, 2, -1, 2, 2},  std::vector<double>{2e9, -1e15, 2e9, -1e15, 2e9, 2e9}};
  for (const Values& values : types) {
    mesh.data = {{"region", Association::cells, 1, values, {}, {}}};
    EXPECT_EQ(grouping_by(mesh, "region").of_cells, (std::vector<Index>{1, 0, 1, 0, 1, 1}));
  }
}

TEST(GroupBy, RefusesWhatHoldsNoWholeNumbers) {
  Mesh mesh = test::tetrahedral_bar(1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Values> types{std::vector<double>{1, 1, 1, 1, 1, 1.5},
                                  std::vector<double>{1, 1, 1, 1, 1, nan},
                                  std::vector<double>{1, 1, infinity, 1, 1, 1},
                                  std::vector<float>{1, 1, 1, 1, 1, 1e30F},
                                  std::vector<std::uint64_t>{1, 1, 1, 1, 1, ~std::uint64_t{0}},
                                  std::vector<std::string>{"1", "1", "1", "1", "1", "1"}};
  for (const Values& values : types) {
    mesh.data = {{"region", Association::cells, 1, values, {}, {}},
                 {"good", Association::vertices, 1, std::vector<int>(8, 1), {}, {}}};
    const std::string message = refusal(mesh, "region");
    EXPECT_NE(message.find("'region' on cells"), std::string::npos) << message;
    EXPECT_NE(message.find("good on vertices"), std::string::npos) << message;
  }
  mesh.sets.clear();
  mesh.data = {{"pairs", Association::cells, 2, std::vector<std::int32_t>(12, 1), {}, {}}};
  EXPECT_NE(refusal(mesh, "pairs").find("by: none"), std::string::npos);
}

TEST(GroupBy, FindsArraysByNameCellsFirstOrByPrefix) {
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.data = {{"tag", Association::vertices, 1, std::vector<std::int32_t>(8, 4), {}, {}},
               {"tag", Association::cells, 1, std::vector<std::int32_t>(6, 5), {}, {}},
               {"zone", Association::vertices, 1, std::vector<std::int32_t>(8, 6), {}, {}},
               {"cells:tag", Association::vertices, 1, std::vector<std::int32_t>(8, 7), {}, {}}};
  const auto value = [&](std::string_view name) { return grouping_by(mesh, name).values.front(); };
  EXPECT_EQ(value("tag"), 5);
  EXPECT_EQ(value("vertices:tag"), 4);
  EXPECT_EQ(value("zone"), 6);
  EXPECT_EQ(value("cells:tag"), 7);
  for (const char* unknown : {"nothing", "cells:zone", "vertices:", ""}) {
    const std::string message = refusal(mesh, unknown);
    EXPECT_NE(message.find("tag on cells"), std::string::npos) << message;
    EXPECT_NE(message.find("zone on vertices"), std::string::npos) << message;
  }
}

TEST(GroupBy, SetsOfCellsGroupByTheSmallestThatHoldsACell) {
  Mesh mesh = test::tetrahedral_bar(2);
  mesh.data.clear();
  mesh.sets = {{"fixed", Association::vertices, {0, 1}},
               {"all", Association::cells, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}},
               {"left", Association::cells, {5, 4, 3, 2}},
               {"unused", Association::cells, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}},
               {"right", Association::cells, {9, 8, 5}}};
  const Grouping grouping = grouping_by(mesh, "sets");
  EXPECT_EQ(grouping.names, (std::vector<std::string>{"all", "left", "right"}));
  EXPECT_EQ(grouping.values, (std::vector<std::int64_t>{1, 2, 4}));
  EXPECT_EQ(grouping.of_cells, (std::vector<Index>{0, 0, 1, 1, 1, 2, 0, 0, 2, 2, 0, 3}));
  EXPECT_EQ(group_sizes(grouping)[2].name, "right");
  const MeshOrder result = reorder(mesh, grouped("sets"));
  std::vector<Index> after(12);
  for (Index c = 0; c < 12; ++c) after[result.cells.permutation.old_to_new()[c]] = grouping.of_cells[c];
  EXPECT_TRUE(std::is_sorted(after.begin(), after.end()));
  EXPECT_NE(refusal(mesh, "set").find("by: sets"), std::string::npos);
  mesh.sets.resize(1);
  EXPECT_NE(refusal(mesh, "sets").find("by: none"), std::string::npos);
}

TEST(GroupBy, OfOneGroupIsTheOrderWithoutGroups) {
  Mesh mesh = test::tetrahedral_bar(7);
  mesh.data = {{"tag", Association::cells, 1, std::vector<std::int32_t>(42, 5), {}, {}}};
  Mesh other = mesh;
  ReorderOptions by_tag = grouped("tag", "fiedler");
  by_tag.methods.elements = "lexmax";
  ReorderOptions by_nothing = by_tag;
  by_nothing.group_by.clear();
  const MeshOrder with = reorder(mesh, by_tag);
  const MeshOrder without = reorder(other, by_nothing);
  EXPECT_EQ(with.vertices.permutation, without.vertices.permutation);
  EXPECT_EQ(with.cells.permutation, without.cells.permutation);
}

}  // namespace
}  // namespace meshorder
