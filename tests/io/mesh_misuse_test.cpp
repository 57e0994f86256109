// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Calls every function that takes a mesh with every kind of wrong member. Each call must throw an Error and
// leave the mesh unchanged.
#include "base/index.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

using Change = std::function<void(Mesh&)>;

/// Two tetrahedra with an array and a set on vertices and on cells, and ids.
Mesh right_mesh() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.cells.push_back(Shape::tetrahedron, std::vector<Index>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::tetrahedron, std::vector<Index>{1, 2, 3, 4});
  mesh.data.push_back({"a", Association::vertices, 1, std::vector<double>(5), {}, {}});
  mesh.data.push_back({"b", Association::cells, 3, std::vector<float>(3), {1}, {}});
  mesh.sets.push_back({"s", Association::vertices, {4, 0}});
  mesh.sets.push_back({"t", Association::cells, {1}});
  mesh.sets.push_back({"u", Association::vertices, {3, 4, 2}});
  mesh.vertex_ids = {5, 4, 3, 2, 1};
  mesh.cell_ids = {7, 8};
  return mesh;
}

const std::vector<std::pair<std::string, Change>>& wrong_members() {
  static const std::vector<std::pair<std::string, Change>> changes{
      {"a coordinate that is NaN", [](Mesh& m) { m.points[2][1] = kNotANumber; }},
      {"an infinite coordinate", [](Mesh& m) { m.points[2][1] = kEndless; }},
      {"too few points", [](Mesh& m) { m.points.pop_back(); }},
      {"no points", [](Mesh& m) { m.points.clear(); }},
      {"offsets too short", [](Mesh& m) { m.cells.offsets.pop_back(); }},
      {"offsets too long", [](Mesh& m) { m.cells.offsets.push_back(8); }},
      {"no offsets", [](Mesh& m) { m.cells.offsets.clear(); }},
      {"decreasing offsets",
       [](Mesh& m) {
         m.cells.offsets = {0, 9, 8};
       }},
      {"a huge offset", [](Mesh& m) { m.cells.offsets[2] = std::numeric_limits<Offset>::max(); }},
      {"a negative offset", [](Mesh& m) { m.cells.offsets[1] = -4; }},
      {"a first offset other than 0", [](Mesh& m) { m.cells.offsets[0] = 1; }},
      {"shapes too short", [](Mesh& m) { m.cells.shapes.pop_back(); }},
      {"an unknown shape", [](Mesh& m) { m.cells.shapes[1] = static_cast<Shape>(99); }},
      {"a shape with more corners", [](Mesh& m) { m.cells.shapes[1] = Shape::hexahedron; }},
      {"a cell without vertices",
       [](Mesh& m) {
         m.cells.offsets = {0, 8, 8};
       }},
      {"vertices too short", [](Mesh& m) { m.cells.vertices.pop_back(); }},
      {"vertices too long", [](Mesh& m) { m.cells.vertices.push_back(0); }},
      {"a vertex below 0", [](Mesh& m) { m.cells.vertices[5] = -1; }},
      {"a vertex beyond", [](Mesh& m) { m.cells.vertices[5] = 5; }},
      {"a huge vertex", [](Mesh& m) { m.cells.vertices[5] = std::numeric_limits<Index>::max(); }},
      {"an array too short", [](Mesh& m) { m.data[0].values = std::vector<double>(4); }},
      {"an array too long", [](Mesh& m) { m.data[0].values = std::vector<double>(6); }},
      {"an array of no components", [](Mesh& m) { m.data[0].components = 0; }},
      {"an array of negative components", [](Mesh& m) { m.data[0].components = -1; }},
      {"an array of huge components",
       [](Mesh& m) { m.data[0].components = std::numeric_limits<Index>::max(); }},
      {"rows too short", [](Mesh& m) { m.data[1].values = std::vector<float>(2); }},
      {"rows too long", [](Mesh& m) { m.data[1].values = std::vector<float>(4); }},
      {"a row of a cell beyond", [](Mesh& m) { m.data[1].indices = {2}; }},
      {"a row of a cell below 0", [](Mesh& m) { m.data[1].indices = {-1}; }},
      {"two rows of a cell",
       [](Mesh& m) {
         m.data[1].values = std::vector<float>(6);
         m.data[1].indices = {1, 1};
       }},
      {"rows that come again after others",
       [](Mesh& m) {
         m.data[0].values = std::vector<double>(3);
         m.data[0].indices = {3, 0, 3};
       }},
      {"a member that comes twice",
       [](Mesh& m) {
         m.sets[1].members = {1, 0, 1};
       }},
      {"a member beyond",
       [](Mesh& m) {
         m.sets[0].members = {0, 5};
       }},
      {"a member below 0", [](Mesh& m) { m.sets[1].members = {-1}; }},
      {"ids of vertices too short", [](Mesh& m) { m.vertex_ids.pop_back(); }},
      {"ids of vertices too long", [](Mesh& m) { m.vertex_ids.push_back(9); }},
      {"ids of cells too short", [](Mesh& m) { m.cell_ids.pop_back(); }},
      {"ids of cells too long", [](Mesh& m) { m.cell_ids.push_back(9); }},
      {"blocks beyond",
       [](Mesh& m) {
         m.cell_blocks = {0, 3};
       }},
      {"blocks that do not begin at 0", [](Mesh& m) { m.cell_blocks = {1}; }},
      {"blocks that descend",
       [](Mesh& m) {
         m.cell_blocks = {0, 1, 0};
       }},
  };
  return changes;
}

TEST(MeshMisuse, IsRefusedByEveryFunction) {
  const std::vector<std::pair<std::string, Change>> takers{
      {"check_mesh", [](Mesh& m) { check_mesh(m); }},
      {"reorder", [](Mesh& m) { (void)reorder(m); }},
      {"reorder by groups", [](Mesh& m) { (void)reorder(m, {.group_by = "sets"}); }},
      {"apply_reordering",
       [](Mesh& m) {
         apply_reordering(m, test::shuffled(5, 1), Permutation::from_old_to_new({1, 0}));
       }},
      {"keep_cells", [](Mesh& m) { (void)keep_cells(m, {.format = "vtu", .dimension = 3}); }},
      {"write_mesh",
       [](Mesh& m) {
         std::ostringstream stream;
         (void)write_mesh(m, stream, "vtu");
       }},
      {"write_mesh_to_memory", [](Mesh& m) { (void)write_mesh_to_memory(m, "gmsh", "a.msh"); }},
  };
  for (const auto& [function, take] : takers) {
    Mesh right = right_mesh();
    ASSERT_NO_THROW(take(right)) << function;
    for (const auto& [what, change] : wrong_members()) {
      SCOPED_TRACE(function + ": " + what);
      Mesh mesh = right_mesh();
      change(mesh);
      const Mesh before = mesh;
      EXPECT_THROW(take(mesh), InvalidArgument);
      EXPECT_EQ(mesh.cells, before.cells);
      EXPECT_EQ(mesh.sets, before.sets);
      EXPECT_EQ(mesh.vertex_ids, before.vertex_ids);
      EXPECT_EQ(mesh.cell_ids, before.cell_ids);
    }
  }
}

TEST(MeshMisuse, OfOrdersAndViewsIsRefused) {
  const Permutation five = Permutation::identity(5);
  const Permutation two = Permutation::identity(2);
  Mesh mesh = right_mesh();
  EXPECT_THROW(apply_reordering(mesh, Permutation::identity(4), two), InvalidArgument);
  EXPECT_THROW(apply_reordering(mesh, Permutation::identity(6), two), InvalidArgument);
  EXPECT_THROW(apply_reordering(mesh, {}, two), InvalidArgument);
  EXPECT_THROW(apply_reordering(mesh, five, Permutation::identity(1)), InvalidArgument);
  EXPECT_THROW(apply_reordering(mesh, five, Permutation::identity(3)), InvalidArgument);
  mesh.cell_blocks = {0, 1};
  EXPECT_THROW(apply_reordering(mesh, five, Permutation::from_old_to_new({1, 0})), InvalidArgument);
  mesh.cell_blocks.clear();
  EXPECT_THROW((void)keep_cells(mesh, {.dimension = 4}), InvalidArgument);
  EXPECT_THROW((void)keep_cells(mesh, {.dimension = -2}), InvalidArgument);
  EXPECT_THROW((void)keep_cells(mesh, {.dimension = 1}), InvalidArgument);
  EXPECT_THROW((void)reorder(mesh, {.group_by = "no such array"}), InvalidArgument);
  EXPECT_THROW((void)reorder(mesh, {.format = "no such format"}), InvalidArgument);
  EXPECT_EQ(mesh.cells, right_mesh().cells);
  EXPECT_EQ(mesh.points, right_mesh().points);

  const std::vector<Point> points(4);
  const std::vector<Index> vertices{0, 1, 2, 4};
  const CellsView beyond = CellsView::uniform(Shape::tetrahedron, 4, vertices);
  EXPECT_THROW((void)make_mesh({.points = points, .cells = beyond}), InvalidArgument);
  EXPECT_THROW((void)make_mesh({.points = points, .cells = beyond, .vertex_count = 5}), InvalidArgument);
}

TEST(AllBelow, SeesEveryNumberOutOfRangeAtEveryPlace) {
  constexpr Index kLeast = std::numeric_limits<Index>::min();
  constexpr Index kMost = std::numeric_limits<Index>::max();
  const auto is_below = [](Index number, Index limit) { return number >= 0 && number < limit; };
  for (const Index limit : {0, 1, 2, 100, 1 << 30, kMost - 1, kMost}) {
    EXPECT_TRUE(all_below({}, limit));
    for (const Index number :
         {kLeast, kLeast + 1, -limit, -1, 0, 1, 99, limit - 1, limit, 1 << 30, kMost - 1, kMost}) {
      for (std::size_t place = 0; place < 37; ++place) {
        std::vector<Index> numbers(37, 0);
        numbers[place] = number;
        EXPECT_EQ(all_below(numbers, limit), limit > 0 && is_below(number, limit))
            << number << " below " << limit;
      }
    }
  }
}

}  // namespace
}  // namespace meshorder
