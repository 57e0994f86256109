// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace meshorder {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::StartsWith;

constexpr std::string_view kHouseWithRoof = R"(# a house
# with a roof
mtllib house.mtl more.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0 0.5
v 0.5 1.5 0.1
v 5 5 5
vt 0 0
vt 1.0 0 # kept as it stands
vt 0.50 1
vn 0 0 1
vn 0 1 0
g walls
o house
usemtl brick
s 1
f 1/1/1 2/2/1 3/3/2 4/1/2
g roof top
usemtl shingle
s off
f 3/1 5/2 4/3
g
o
usemtl
f 1//1 3//2 4//1
f 1 2 3 4 5
l 1/1 2/2
l 1 2 3
p 6
)";

TEST(Obj, TakesSmoothingGroupsWithZerosBefore) {
  const TemporaryFolder folder;
  const auto groups = [&](const std::string& line) {
    std::string text(kHouseWithRoof);
    text.replace(text.find("s 1\n"), 4, line);
    const Mesh mesh = read_mesh(folder.file("a.obj", text));
    return find_array(mesh, "smoothing", Association::cells)->values;
  };
  EXPECT_EQ(groups("s 01\n"), groups("s 1\n"));
  EXPECT_EQ(groups("s 0010\n"), Values(std::vector<std::int32_t>{10, 0, 0, 0, 0, 0, 0}));
}

TEST(Obj, ReadsCellsWithTheirStates) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.obj", kHouseWithRoof));
  EXPECT_EQ(mesh.vertex_count(), 6);
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::quad, Shape::triangle, Shape::triangle, Shape::polygon,
                                            Shape::line, Shape::polyline, Shape::vertex}));
  EXPECT_EQ(mesh.cells.vertices,
            (std::vector<Index>{0, 1, 2, 3, 2, 4, 3, 0, 2, 3, 0, 1, 2, 3, 4, 0, 1, 0, 1, 2, 5}));
  using Ints = std::vector<std::int32_t>;
  const std::vector<DataArray> expected{
      {"obj:weight", Association::vertices, 1, std::vector{0.5}, {3}, {}},
      {"obj:texture2", Association::cells, 2, Ints{0, 1}, {4}, {}},
      {"obj:texture3", Association::cells, 3, Ints{0, 1, 2}, {1}, {}},
      {"obj:texture4", Association::cells, 4, Ints{0, 1, 2, 0}, {0}, {}},
      {"obj:normal3", Association::cells, 3, Ints{0, 1, 0}, {2}, {}},
      {"obj:normal4", Association::cells, 4, Ints{0, 0, 1, 1}, {0}, {}},
      {"object", Association::cells, 1, Ints{1, 1, 0, 0, 0, 0, 0}, {}, {}},
      {"label", Association::cells, 1, Ints{1, 2, 0, 0, 0, 0, 0}, {}, {}},
      {"smoothing", Association::cells, 1, Ints{1, 0, 0, 0, 0, 0, 0}, {}, {}}};
  EXPECT_EQ(mesh.data, expected);
  EXPECT_EQ(mesh.sets, (std::vector<EntitySet>{{"roof", Association::cells, {1}},
                                               {"top", Association::cells, {1}},
                                               {"walls", Association::cells, {0}}}));
}

TEST(Obj, OrdersAndPutsBackEverything) {
  expect_order_and_back_to("a.obj", kHouseWithRoof);
  const TemporaryFolder folder;
  Notes notes;
  write_mesh(read_mesh(folder.file("a.obj", kHouseWithRoof)), folder.path() / "b.obj", &notes);
  EXPECT_TRUE(notes.empty());
}

TEST(Obj, StatesChangeWhereTheyChangeInTheNewOrder) {
  const TemporaryFolder folder;
  Mesh mesh =
      read_mesh(folder.file("a.obj",
                            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nusemtl b\nf 1/1 2/1 3/2\nusemtl a\n"
                            "f 2 3 1\nusemtl b\nf 3/2 1/2 2/1\n"));
  apply_reordering(mesh, Permutation::from_old_to_new({2, 1, 0}), Permutation::from_new_to_old({0, 2, 1}));
  write_mesh(mesh, folder.path() / "b.obj");
  EXPECT_EQ(content_of(folder.path() / "b.obj"),
            "v 0 1 0\nv 1 0 0\nv 0 0 0\nvt 0 0\nvt 1 1\nusemtl b\nf 3/1 2/1 1/2\nf 1/2 3/2 2/1\nusemtl a\nf "
            "2 1 3\n");
}

TEST(Obj, FacesOfEqualStatementsStayTogether) {
  std::string text;
  for (int v = 0; v < 60; ++v)
    text += "v " + std::to_string(v * 7 % 60) + " 0 0\nv 0 " + std::to_string(v) + " 1\n";
  text += "f 1 2 3\nusemtl red\n";
  for (int f = 0; f < 100; ++f) {
    if (f == 30) text += "g lid\n";
    if (f == 60) text += "usemtl blue\n";
    const int v = f * 37 % 117 + 1;
    text += fmt::format("f {} {} {}\n", v, v + 1, v + 3);
  }
  const TemporaryFolder folder;
  const auto statements_by = [&](const ReorderOptions& options) {
    Mesh mesh = read_mesh(folder.file("a.obj", text));
    EXPECT_FALSE(reorder(mesh, options).cells.permutation.is_identity());
    write_mesh(mesh, folder.path() / "b.obj");
    std::vector<std::string> statements;
    std::istringstream lines(content_of(folder.path() / "b.obj"));
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("v ") && (!line.starts_with("f ") || statements.empty()))
        statements.push_back(line);
    }
    return statements;
  };
  EXPECT_THAT(statements_by({.methods = {"scrambled", "scrambled"}}),
              ElementsAre(StartsWith("f "), "usemtl red", "g lid", "usemtl blue"));
  EXPECT_GT(statements_by({.methods = {"scrambled", "lexmax"}, .group_by = "sets"}).size(), 10)
      << "other groups were asked for";
}

TEST(Obj, TakesNegativeIndicesContinuedLinesAndIndicesAhead) {
  const TemporaryFolder folder;
  const Mesh mesh =
      read_mesh(folder.file("a.obj",
                            "f 1 2 4\r\nv 0 0 0\rv 1 0 0\nv 0 \\\n 1 \\\r\n0\nf -3 -2 \\\r-1\nv 1 1 1\n"
                            "vt 0 # late\nf -1/-1 -2/-1 -3/-1\n"
                            "f 1 2 3 # done"));
  EXPECT_EQ(mesh.points[2], (Point{0, 1, 0}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 3, 0, 1, 2, 3, 2, 1, 0, 1, 2}));
}

TEST(Obj, TakesCornersThatEndInSlashes) {
  const TemporaryFolder folder;
  const std::string lists = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\n";
  const Mesh plain = read_mesh(folder.file("plain.obj", lists + "f 1 2 3\nf 1/1 2/1 3/1\nl 1 2\np 3\n"));
  for (const std::string_view slashes : {"/", "//"}) {
    const std::string text =
        fmt::format("{0}f 1{1} 2{1} 3{1}\nf 1/1/ 2/1/ 3/1/\nl 1{1} 2{1}\np 3{1}\n", lists, slashes);
    const Mesh mesh = read_mesh(folder.file("a.obj", text));
    EXPECT_EQ(mesh.cells, plain.cells) << slashes;
    EXPECT_EQ(mesh.data, plain.data) << slashes;
  }
}

TEST(Obj, KeepsVertexColors) {
  expect_order_and_back_to("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 1\nv 0 1 0 0.25 0 0\nf 1 2 3\n");
  expect_order_and_back_to("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0.5\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 2 4 3\n");
  expect_order_and_back_to("a.obj", "v 0 0 0 inf 0 -inf\nv 1 0 0 0 0 1\nv 0 1 0 0.25 0 0\nf 1 2 3\n");
  const TemporaryFolder folder;
  const std::string nan = "v 0 0 0 nan nan nan\nv 1 0 0 0 0 1\nv 0 1 0 0.25 0 0\nf 1 2 3\n";
  write_mesh(read_mesh(folder.file("a.obj", nan)), folder.path() / "b.obj");
  EXPECT_EQ(test::content_of(folder.path() / "b.obj"), nan);
}

TEST(Obj, KeepsNamesThatNoCellHas) {
  expect_order_and_back_to(
      "a.obj",
      "v 0 0 0\nv 1 0 0\nv 0 1 0\ng empty\no none\nusemtl gold\ng\no\nusemtl a b#1\ns 3\nlod 2\n"
      "f 1 2 3\nf 3 2 1\n");
}

TEST(Obj, KeepsTheOrderOfTheNamesOfGroups) {
  expect_order_and_back_to("a.obj",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\ng front cube\nf 1 2 3\ng back cube\nf 3 2 1\n"
                           "g cube lid\nf 2 3 1\ng front cube\nf 2 1 3\n");
}

TEST(Obj, NumbersMaterialsByTheirNamesWhereThoseAreNumbers) {
  const TemporaryFolder folder;
  const std::string lists = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  using Ints = std::vector<std::int32_t>;
  const auto labels = [&](const std::string& cells) {
    const Mesh mesh = read_mesh(folder.file("a.obj", lists + cells));
    return find_array(mesh, kLabel, Association::cells)->values;
  };
  EXPECT_EQ(labels("usemtl 7\nf 1 2 3\nusemtl -2\nf 1 2 3\n"), Values(Ints{7, -2}));
  EXPECT_EQ(labels("usemtl z\nf 1 2 3\nusemtl 5\nf 1 2 3\n"), Values(Ints{2, 1}));
  EXPECT_EQ(labels("f 1 2 3\nusemtl 0\nf 1 2 3\n"), Values(Ints{0, 1}));
}

TEST(Obj, BrokenFilesStopWithTheirLine) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_broken(
      "a.obj",
      {{"garbage", "\x7f\x45\x4c\x46 garbage", ":1: the statement '?ELF' is unknown"},
       {"binary", std::string("\0\1\2\3", 4), ":1: the statement"},
       {"only comments", "# nothing\n", "has no cells"},
       {"only vertices", vertices, "has no cells"},
       {"two coordinates", "v 0 0\n", ":1: a vertex has 2 numbers"},
       {"five numbers", "v 0 0 0 1 1\n", ":1: a vertex has 5 numbers"},
       {"seven numbers", "v 0 0 0 1 1 1 1\n", ":1: a vertex has more than 6 numbers"},
       {"nan", "v 0 0 0\nv 0 nan 0\n", ":2: a coordinate is not finite"},
       {"infinite", "v 0 0 inf\n", ":1: a coordinate is not finite"},
       {"no number", "v 0 x 0\n", ":1: a coordinate is 'x'"},
       {"no colour", "v 0 0 0 1 x 0\n", ":1: a weight or colour is 'x'"},
       {"texture of words", "vt a\n", ":1: a number of vt is 'a'"},
       {"texture of none", "vt\n", ":1: a line vt has 0 numbers; 1 to 3 are needed"},
       {"normal of two", "vn 0 0\n", ":1: a line vn has 2 numbers; 3 are needed"},
       {"vertex zero", vertices + "f 0 1 2\n", ":4: v 0 does not exist"},
       {"vertex too large", vertices + "f 1 2 4\n\n", ":4: v 4 does not exist; there are 3, counted from 1"},
       {"absurd vertex", vertices + "f 1 2 1000000000000\n",
        ":4: a number of v is 1000000000000; it is too large"},
       {"too far back", vertices + "f -1 -2 -4\n", ":4: v -4 does not exist"},
       {"vertex no number", vertices + "f 1 2 x\n", ":4: a number of v is 'x'"},
       {"texture too large", vertices + "vt 0\nf 1/1 2/1 3/2\n", ":5: vt 2 does not exist"},
       {"no normals", vertices + "f 1//1 2//1 3//1\n", ":4: vn 1 does not exist"},
       {"mixed corners", vertices + "vt 0\nf 1/1 2/1 3\n", ":5: corners of one cell have different"},
       {"three slashes", vertices + "f 1/// 2 3\n", ":4: a number of vn is '/'"},
       {"too many slashes", vertices + "vt 0\nvn 1 0 0\nf 1/1/1/1 2 3\n", ":6: a number of vn is '1/1'"},
       {"face of two", vertices + "f 1 2\n",
        ":4: a face has 2 corners; it needs 3 or more, and a line is written as 'l 1 2'"},
       {"face of one", vertices + "f 1//\n",
        ":4: a face has 1 corner; it needs 3 or more, and a point is written as 'p 1//'"},
       {"face of none", vertices + "f # 1 2 3\n", ":4: a face has 0 corners; it needs 3 or more"},
       {"line of one", vertices + "l 1\n",
        ":4: a line has 1 corner; it needs 2 or more, and a point is written as 'p 1'"},
       {"point of none", vertices + "p\n", ":4: a point has 0 corners; it needs 1 or more"},
       {"error in a continued line", vertices + "f 1 \\\n2 \\\nx\n", ":4: a number of v is 'x'"},
       {"ends continued", vertices + "f 1 2 \\", ":4: a face has 2 corners"},
       {"smoothing", vertices + "s smooth\nf 1 2 3\n", ":4: the smoothing group is 'smooth'"},
       {"free form", vertices + "cstype bspline\n", ":4: free-form geometry ('cstype') is not read"},
       {"parameter vertex", "vp 0 1\n", ":1: free-form geometry ('vp') is not read"},
       {"curve", vertices + "curv 0 1 1 2 3\n", ":4: free-form geometry ('curv') is not read"},
       {"unknown", vertices + "call other.obj\n", ":4: the statement 'call' is unknown"}});
}

// OBJ has no counts: a file that ends after a line, or within a number, is valid
TEST(Obj, NoticesThatVerticesAreMissing) {
  const std::string text = "f 1 2 3\nf 2 3 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n";
  expect_truncation_is_noticed("a.obj", text);
}

TEST(Obj, WritesAndReadsItsTypes) {
  for (const auto& [shape, width] : std::vector<std::pair<Shape, int>>{{Shape::vertex, 1},
                                                                       {Shape::poly_vertex, 4},
                                                                       {Shape::line, 2},
                                                                       {Shape::polyline, 5},
                                                                       {Shape::triangle, 3},
                                                                       {Shape::quad, 4},
                                                                       {Shape::polygon, 7}}) {
    Mesh mesh = cells_of_type(shape, width, 5);
    std::erase_if(mesh.data, [](const DataArray& a) {
      return a.association == Association::vertices || a.name != kLabel;
    });
    std::erase_if(mesh.sets, [](const EntitySet& set) { return set.association == Association::vertices; });
    expect_write_and_read(mesh, "a.obj");
  }
}

TEST(Obj, WritesOtherMeshesExactlySoAndNotesWhatItCannotHold) {
  const TemporaryFolder folder;
  Mesh mesh = cells_of_type(Shape::triangle, 3, 1);
  mesh.points = {{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.cell_ids = {77};
  mesh.sets.push_back({"two words", Association::cells, {0}});
  for (const char* component : {"nx", "ny", "nz"}) {
    mesh.data.push_back({component, Association::vertices, 1, std::vector<float>{0, 0.5F, 1}, {}, {}});
  }
  mesh.data.push_back({"texture", Association::vertices, 2, std::vector<double>{0, 0, 1, 0, 0, 1}, {}, {}});
  mesh.data.push_back(
      {"color", Association::vertices, 3, std::vector<std::uint8_t>{255, 0, 0, 0, 51, 0, 0, 0, 0}, {}, {}});
  Notes notes;
  write_mesh(mesh, folder.path() / "a.obj", &notes);
  EXPECT_EQ(
      content_of(folder.path() / "a.obj"),
      "v 0.1 0 0 1 0 0\nv 1 0 0 0 0.2 0\nv 0 1 0 0 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 0\nvn 0.5 0.5 0.5\n"
      "vn 1 1 1\ng part two_words\nusemtl 1\nf 1/1/1 2/2/2 3/3/3\n");
  EXPECT_EQ(notes, (Notes{"labels of cells are written as materials (usemtl) of their numbers",
                          "the array 'label' on vertices is not written: OBJ cannot hold it",
                          "the array 'temperature' on vertices is not written: OBJ cannot hold it",
                          "the array 'stress' on vertices is not written: OBJ cannot hold it",
                          "the array 'temperature' on cells is not written: OBJ cannot hold it",
                          "the array 'stress' on cells is not written: OBJ cannot hold it",
                          "the set 'fixed' of vertices is not written: OBJ cannot hold it",
                          "the set 'two words' is written as the group 'two_words'",
                          "the ids of cells are not written: OBJ numbers them by position"}));
}

TEST(Obj, OtherFormatsNameWhatIsLost) {
  const TemporaryFolder folder;
  Notes notes;
  write_mesh(
      read_mesh(folder.file("a.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n")),
      folder.path() / "a.off", &notes);
  EXPECT_EQ(notes, (Notes{"the array 'label' on cells is not written: OFF cannot hold it",
                          "not written (OFF cannot hold it): the names of material libraries",
                          "not written (OFF cannot hold it): usemtl red, which is 1 in the array 'label'"}));
}

TEST(Obj, RefusesVolumesAndCurvedCells) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.obj";
  EXPECT_NE(write_error(tetrahedral_bar(1), path).find("OBJ cannot hold a cell of type tetrahedron"),
            std::string::npos);
  EXPECT_NE(write_error(cells_of_type(Shape::quad, 9, 1), path).find("of type quad9"), std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace meshorder
