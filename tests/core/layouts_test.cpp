// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/index.hpp"
#include "mesh/procedural.hpp"
#include "support/refusal.hpp"
#include <meshorder/layouts.hpp>
#include <meshorder/mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <vector>

namespace meshorder {
namespace {

using test::refusal;
using testing::HasSubstr;

Mesh scrambled_grid() {
  Mesh mesh = make_grid({.size = 15});
  (void)reorder(mesh, {.methods = {"scrambled", "hilbert"}});
  return mesh;
}

std::vector<Index> all_of(Index n) {
  std::vector<Index> numbers(n);
  std::iota(numbers.begin(), numbers.end(), Index{0});
  return numbers;
}

TEST(Patches, HoldEachCellOnceByItsOwnVertices) {
  const Mesh mesh = scrambled_grid();
  const std::size_t n = mesh.points.size();
  for (const int size : {2, 7, 256, 16383}) {
    const Patches cut = patches(view(mesh).cells, n, size);
    const auto m = static_cast<std::size_t>(mesh.cell_count());
    ASSERT_EQ(cut.count(), (m + size - 1) / size);
    std::vector<Index> seen = cut.cells;
    std::ranges::sort(seen);
    EXPECT_EQ(seen, all_of(mesh.cell_count()));
    for (std::size_t i = 0; i < m; ++i) {
      const std::size_t patch = i / size;
      EXPECT_EQ(cut.cells[i] / size, static_cast<Index>(patch)) << "patches follow the order of the cells";
      const std::span<const Index> vertices = cut.vertices_of(patch);
      EXPECT_EQ(std::ranges::adjacent_find(vertices, std::greater_equal()), vertices.end());
      for (int a = 0; a < 4; ++a) ASSERT_EQ(vertices[cut.local[4 * i + a]], mesh.cells[cut.cells[i]][a]) << i;
    }
    std::set<std::pair<std::size_t, Index>> needed;
    for (Index c = 0; c < mesh.cell_count(); ++c)
      for (const Index v : mesh.cells[c]) needed.emplace(c / size, v);
    EXPECT_EQ(cut.vertices.size(), needed.size()) << "no vertex that no cell of the patch has";
    for (const int threads : {1, 2, 7}) {
      const Patches again = patches(view(mesh).cells, n, size, {.threads = threads});
      EXPECT_EQ(again.cells, cut.cells);
      EXPECT_EQ(again.local, cut.local);
      EXPECT_EQ(again.vertices, cut.vertices);
      EXPECT_EQ(again.offsets, cut.offsets);
    }
  }
}

TEST(Patches, DealCellsOutToWarps) {
  const Mesh mesh = scrambled_grid();
  const Patches cut = patches(view(mesh).cells, mesh.points.size(), 256);
  const std::span first(cut.cells.data(), 34);
  for (Index lane = 0; lane < 32; ++lane) EXPECT_EQ(first[lane], 8 * lane);
  EXPECT_EQ(first[32], 1);
  EXPECT_EQ(first[33], 9);
}

TEST(Patches, FillAllWarpsButTheLast) {
  const Mesh mesh = scrambled_grid();
  const Patches cut = patches(view(mesh).cells, mesh.points.size(), 100);
  for (const Index first : {0, 32, 64}) {
    for (Index i = first + 1; i < first + 32; ++i) EXPECT_GE(cut.cells[i], cut.cells[i - 1] + 3) << i;
  }
}

TEST(Patches, HaveLocalNumbersOfSixteenBits) {
  std::vector<Index> vertices(3 * 21845);
  std::iota(vertices.begin(), vertices.end(), Index{0});
  const Patches cut = patches(CellsView::uniform(Shape::triangle, 3, vertices), vertices.size(), 21845);
  EXPECT_EQ(cut.count(), 1U);
  EXPECT_EQ(cut.vertices, vertices);
  EXPECT_EQ(*std::ranges::max_element(cut.local), 65534);
  for (std::size_t i = 0; i < cut.local.size(); ++i)
    ASSERT_EQ(cut.local[i], static_cast<std::uint16_t>(3 * cut.cells[i / 3] + i % 3));
}

TEST(GatherLists, NameEachCornerOfEachCellOnce) {
  Mesh mesh = scrambled_grid();
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{5, 3, 4});
  const GatherLists lists = gather_lists(view(mesh).cells, mesh.points.size());
  ASSERT_EQ(lists.offsets.size(), mesh.points.size() + 1);
  ASSERT_EQ(lists.cells.size(), mesh.cells.vertices.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    for (Offset k = lists.offsets[v]; k < lists.offsets[v + 1]; ++k) {
      EXPECT_EQ(mesh.cells[lists.cells[k]][lists.corners[k]], v);
      if (k > lists.offsets[v]) {
        EXPECT_LT(lists.cells[k - 1], lists.cells[k]);
      }
    }
  }
}

TEST(GatherLists, NameAVertexThatACellHasTwiceTwice) {
  const std::array<Index, 6> triangles{1, 0, 1, 2, 1, 1};
  const GatherLists lists = gather_lists(CellsView::uniform(Shape::triangle, 3, triangles), 3);
  EXPECT_THAT(lists.offsets, testing::ElementsAre(0, 1, 5, 6));
  EXPECT_THAT(lists.cells, testing::ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(lists.corners, testing::ElementsAre(1, 0, 2, 1, 2, 0));
}

void expect_proper(const Colours& colours, const Cells& cells) {
  std::vector<Index> seen = colours.cells;
  std::ranges::sort(seen);
  EXPECT_EQ(seen, all_of(index_size(cells.shapes)));
  for (std::size_t colour = 0; colour < colours.count(); ++colour) {
    const std::span own(colours.cells.data() + colours.starts[colour],
                        colours.cells.data() + colours.starts[colour + 1]);
    EXPECT_FALSE(own.empty());
    EXPECT_TRUE(std::ranges::is_sorted(own)) << "each colour keeps the order";
    std::set<Index> vertices;
    for (const Index c : own)
      for (const Index v : cells[c]) EXPECT_TRUE(vertices.insert(v).second) << v;
  }
}

TEST(Colours, HaveNoVertexTwice) {
  const Mesh mesh = scrambled_grid();
  const Colours found = colours(view(mesh).cells, mesh.points.size());
  expect_proper(found, mesh.cells);
  EXPECT_LT(found.count(), 64U);
  EXPECT_GE(found.count(), 24U) << "as many as cells at a vertex inside";
}

TEST(Colours, OfAStarAreAsManyAsItsEdges) {
  constexpr Index kEdges = 100'000;
  Mesh star;
  star.points.resize(kEdges + 1);
  for (Index v = 1; v <= kEdges; ++v) star.cells.push_back(Shape::line, std::array<Index, 2>{v, 0});
  const Colours found = colours(view(star).cells, star.points.size());
  EXPECT_EQ(found.cells, all_of(kEdges));
  EXPECT_EQ(found.count(), static_cast<std::size_t>(kEdges));
}

TEST(Colours, BeyondTheFirstOnesAreProper) {
  // all pairs of 300 vertices, which need 299 colours
  Mesh complete;
  complete.points.resize(300);
  for (Index a = 0; a < 300; ++a)
    for (Index b = 0; b < a; ++b) complete.cells.push_back(Shape::line, std::array<Index, 2>{a, b});
  const Colours found = colours(view(complete).cells, 300);
  expect_proper(found, complete.cells);
  EXPECT_LT(found.count(), 2U * 299);
}

double volume(const Mesh& mesh, std::span<const Index> corners) {
  std::array<Point, 3> sides{};
  for (int s = 0; s < 3; ++s)
    for (int axis = 0; axis < 3; ++axis)
      sides[s][axis] = mesh.points[corners[s + 1]][axis] - mesh.points[corners[0]][axis];
  const auto& [a, b, c] = sides;
  return (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
          a[2] * (b[0] * c[1] - b[1] * c[0])) /
         6;
}

TEST(SortCorners, KeepsTheOrientation) {
  const Mesh mesh = scrambled_grid();
  const std::vector<Index> sorted = sort_corners(view(mesh).cells, mesh.points.size());
  int ascending = 0;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const std::span own(sorted.data() + std::size_t{4} * c, 4);
    EXPECT_THAT(own, testing::UnorderedElementsAreArray(mesh.cells[c]));
    EXPECT_NEAR(volume(mesh, own), volume(mesh, mesh.cells[c]), 1e-15);
    EXPECT_TRUE(std::ranges::is_sorted(own.first(3)) && own[3] > own[1]);
    ascending += std::ranges::is_sorted(own) ? 1 : 0;
  }
  EXPECT_GT(ascending, mesh.cell_count() / 4);
  const std::array<Index, 6> triangles{4, 2, 7, 1, 9, 3};
  EXPECT_THAT(sort_corners(CellsView::uniform(Shape::triangle, 3, triangles), 10),
              testing::ElementsAre(2, 7, 4, 1, 9, 3));
}

TEST(Layouts, AreRefusedWithTheFault) {
  const Mesh mesh = scrambled_grid();
  const CellsView cells = view(mesh).cells;
  const std::size_t n = mesh.points.size();
  for (const int size : {-1, 0, 1, 16384, 1 << 30})
    EXPECT_THAT(refusal([&] { (void)patches(cells, n, size); }), HasSubstr("give 2 to 16383")) << size;
  Mesh mixed = mesh;
  mixed.cells.push_back(Shape::quad, std::array<Index, 4>{0, 1, 2, 3});
  EXPECT_THAT(refusal([&] { (void)patches(view(mixed).cells, n); }),
              HasSubstr("of another type than cell 0"));
  EXPECT_THAT(refusal([&] { (void)sort_corners(view(mixed).cells, n); }), HasSubstr("of another type"));
  const std::array<Index, 4> edges{0, 1, 1, 2};
  EXPECT_THAT(refusal([&] { (void)sort_corners(CellsView::uniform(Shape::line, 2, edges), 3); }),
              HasSubstr("neither triangles nor tetrahedra"));
  const std::vector<Index> wide(40000, 0);
  EXPECT_THAT(refusal([&] { (void)patches(CellsView::uniform(Shape::polygon, 40000, wide), 1); }),
              HasSubstr("too large: a patch must hold two"));
  const std::vector<Index> many(300, 0);
  EXPECT_THAT(refusal([&] { (void)gather_lists(CellsView::uniform(Shape::polygon, 300, many), 1); }),
              HasSubstr("300 vertices, more than 256"));
  for (const auto& layout :
       {+[](const CellsView&c, std::size_t v) { (void)patches(c, v); },
        +[](const CellsView&c, std::size_t v) { (void)gather_lists(c, v); },
        +[](const CellsView&c, std::size_t v) { (void)colours(c, v); },
        +[](const CellsView&c, std::size_t v) { (void)sort_corners(c, v); },
        +[](const CellsView&c, std::size_t v) { (void)gpu_cost(c, v, GpuLayout::padded); }}) {
    EXPECT_THAT(refusal([&] { layout(cells, n - 1); }), HasSubstr("outside 0"));
    layout({}, 0);
    layout({}, 5);
  }
}

}  // namespace
}  // namespace meshorder
