// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

using namespace test;

constexpr std::string_view kHouse = R"(# a house
OFF
# five corners
5 3 6
0 0 0
1 0 0
1 1 0
0 1 0
0.5 1.5 1e-1
4 0 1 2 3 255 0 0
3 2 4 3 0.5 1 0.25
2 0 4
)";

TEST(Off, ReadsFacesAndTheirColors) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.off", kHouse));
  EXPECT_EQ(mesh.points[4], (Point{0.5, 1.5, 0.1}));
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::quad, Shape::triangle, Shape::line}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 3, 2, 4, 3, 0, 4}));
  ASSERT_EQ(mesh.data.size(), 2U);
  EXPECT_EQ(mesh.data[0],
            (DataArray{"color_f3", Association::cells, 3, std::vector{0.5, 1.0, 0.25}, {1}, {}}));
  EXPECT_EQ(mesh.data[1],
            (DataArray{"color_i3", Association::cells, 3, std::vector<std::int32_t>{255, 0, 0}, {0}, {}}));
}

TEST(Off, WritesColorsInTheirNumberTypeAndKeepsComments) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.off", kHouse));
  apply_reordering(mesh, Permutation::from_old_to_new({4, 3, 2, 1, 0}),
                   Permutation::from_old_to_new({1, 0, 2}));
  Notes notes;
  write_mesh(mesh, folder.path() / "b.off", &notes);
  EXPECT_EQ(content_of(folder.path() / "b.off"),
            "OFF\n# a house\n# five corners\n5 3 6\n0.5 1.5 0.1\n0 1 0\n1 1 0\n1 0 0\n0 0 0\n"
            "3 2 0 1 0.5 1.0 0.25\n4 4 3 2 1 255 0 0\n2 4 0\n");
  EXPECT_TRUE(notes.empty());
}

TEST(Off, KeepsColorsThatAreTooLargeForIntegers) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.off",
                                          "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
                                          "3 0 1 2 255 4294967296 0\n3 1 3 2 0.5 1 0.25\n"));
  const DataArray* const color = find_array(mesh, "color", Association::cells);
  ASSERT_NE(color, nullptr);
  EXPECT_EQ(color->values, Values(std::vector<double>{255, 4294967296, 0, 0.5, 1, 0.25}));
  write_mesh(mesh, folder.path() / "b.off");
  const Mesh back = read_mesh(folder.path() / "b.off");
  EXPECT_EQ(*find_array(back, "color", Association::cells), *color);
}

TEST(Off, KeepsNormalsColorsAndTextureOfVertices) {
  const TemporaryFolder folder;
  const std::string text =
      "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 127 0 0\n1 0 0 0 0 1 0 255 0 127 1 0\n"
      "0 1 0 0 1 0 0 0 255 127 0 0.5\n3 0 1 2\n";
  const Mesh mesh = read_mesh(folder.file("a.off", text));
  ASSERT_EQ(mesh.data.size(), 3U);
  EXPECT_EQ(mesh.data[0].name, "normal");
  EXPECT_EQ(mesh.data[0].values, Values(std::vector<double>{0, 0, 1, 0, 0, 1, 0, 1, 0}));
  EXPECT_EQ(mesh.data[1].name, "color");
  EXPECT_EQ(mesh.data[1].components, 4);
  EXPECT_TRUE(std::holds_alternative<std::vector<std::int32_t>>(mesh.data[1].values));
  EXPECT_EQ(mesh.data[2].values, Values(std::vector<double>{0, 0, 1, 0, 0, 0.5}));
  write_mesh(mesh, folder.path() / "b.off");
  EXPECT_EQ(content_of(folder.path() / "b.off"), text);
}

TEST(Off, OrdersAndPutsBackWhatIsAttached) {
  const TemporaryFolder folder;
  expect_order_and_back(
      folder.file("a.off",
                  "COFF\n4 3 0\n0 0 0 1.0 0 0\n1 0 0 0 1.0 0\n0 1 0 0 0 1.0\n1 1 1 0.5 0 0\n"
                  "3 0 1 2 1\n3 1 2 3 5\n1 3 7\n"));
}

TEST(Off, TakesHeadersAsTheyAreFound) {
  const TemporaryFolder folder;
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const Mesh expected = read_mesh(folder.file("a.off", "OFF\n3 1 0\n" + body));
  for (const std::string header : {"OFF 3 1 0\n", "OFF3 1 0\n", "3 1 0\n", "OFF\n3 1\n",
                                   "\r\nOFF # x\r3 1 0 # y\n\n", "OFF\n\n# c\n\n 3\n1\n"}) {
    SCOPED_TRACE(header);
    expect_same(read_mesh(folder.file("b.off", header + body)), expected);
  }
}

TEST(Off, TakesVerticesThatRunOverLines) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.off", "OFF\n3 1 0\n0 0\n0 1 0 0 0\n1 0\n3 0 1 2\n"));
  EXPECT_EQ(mesh.points[2], (Point{0, 1, 0}));
  const Mesh one_line = read_mesh(folder.file("b.off", "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2"));
  EXPECT_EQ(one_line.points, mesh.points);
  EXPECT_EQ(one_line.cells, mesh.cells);
}

TEST(Off, BrokenFilesStopWithTheirLine) {
  const std::string vertices = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  expect_broken(
      "a.off",
      {{"garbage", "\x89PNG\r\n\x1a\n\0\0", ":1: the file does not begin with OFF"},
       {"binary", "OFF BINARY\n\0\0\0\3", ":1: is a binary OFF file"},
       {"four coordinates", "4OFF\n1 1 0\n0 0 0 1\n1 0\n", ":1: points have more than three coordinates"},
       {"n coordinates", "nOFF\n5\n1 1 0\n", ":1: points have more than three coordinates"},
       {"only comments", "# nothing\n\n", "the file does not begin with OFF"},
       {"only the keyword", "OFF\n", "unexpected end of file; expected the number of vertices"},
       {"no vertices", "OFF\n3 1 0\n", ":2: the number of vertices is 3, but only"},
       {"10^12 vertices", "OFF\n1000000000000 1 0\n0 0 0\n", ":2: the number of vertices is 1000000000000"},
       {"negative vertices", "OFF\n-3 1 0\n0 0 0\n", ":2: the number of vertices is -3"},
       {"10^12 faces", "OFF\n1 1000000000000 0\n0 0 0\n", ":2: the number of faces is 1000000000000"},
       {"zero faces", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "has no cells"},
       {"a vertex too few", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ":6: a vertex has more numbers"},
       {"a vertex too many", "OFF\n2 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ":5: a face has no vertices"},
       {"a face too few", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "unexpected end of file; expected the number of a face"},
       {"a face too many", vertices + "3 0 1 2\n3 0 1 2\n", ":7: unexpected data after 1 faces"},
       {"nan", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", ":4: a coordinate is not finite"},
       {"infinite", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 inf\n3 0 1 2\n", ":5: a coordinate is not finite"},
       {"no number", "OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", ":4: a coordinate is 'x'"},
       {"fewer numbers", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", ":4: a vertex has fewer numbers"},
       {"more numbers", "OFF\n3 1 0\n0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n", ":4: a vertex has more numbers"},
       {"half a color", "COFF\n1 1 0\n0 0 0 1 1\n1 0\n", ":3: a vertex has 5 numbers"},
       {"index too large", vertices + "3 0 1 3\n", ":6: a face names vertex 3; there are 3, counted from 0"},
       {"index negative", vertices + "3 0 1 -1\n", ":6: a face names vertex -1"},
       {"index no number", vertices + "3 0 1 x\n", ":6: a vertex of a face is 'x'"},
       {"absurd face", vertices + "1000000000 0 1 2\n", ":6: the number of a face's vertices is 1000000000"},
       {"negative face", vertices + "-3 0 1 2\n", ":6: the number of a face's vertices is -3"},
       {"empty face", vertices + "0 1 2 3\n", ":6: a face has no vertices"},
       {"five color numbers", vertices + "3 0 1 2 1 1 1 1 1\n", "followed by 5 numbers"},
       {"color no number", vertices + "3 0 1 2 red\n", ":6: a colour is 'red'"}});
}

TEST(Off, NoticesTruncation) { expect_truncation_is_noticed("a.off", kHouse); }

TEST(Off, WritesAndReadsItsTypes) {
  for (const auto& [shape, width] : std::vector<std::pair<Shape, int>>{{Shape::vertex, 1},
                                                                       {Shape::line, 2},
                                                                       {Shape::triangle, 3},
                                                                       {Shape::quad, 4},
                                                                       {Shape::polygon, 7}}) {
    Mesh mesh = cells_of_type(shape, width, 5);
    mesh.data.clear();
    mesh.sets.clear();
    mesh.format = "off";
    expect_write_and_read(mesh, "a.off");
  }
}

TEST(Off, RefusesPolygonsThatWouldComeBackAsLines) {
  const TemporaryFolder folder;
  for (const int width : {1, 2}) {
    EXPECT_NE(write_error(cells_of_type(Shape::polygon, width, 1), folder.path() / "a.off")
                  .find("OFF cannot hold a cell of type polygon"),
              std::string::npos);
  }
}

TEST(Off, NotesWhatItCannotHold) {
  const TemporaryFolder folder;
  Mesh mesh = cells_of_type(Shape::triangle, 3, 1);
  mesh.vertex_ids = {2, 3, 4};
  mesh.data.push_back({"red", Association::vertices, 1, std::vector<std::uint8_t>{1, 2, 3}, {}, {}});
  mesh.data.push_back({"green", Association::vertices, 1, std::vector<std::uint8_t>{4, 5, 6}, {}, {}});
  mesh.data.push_back({"blue", Association::vertices, 1, std::vector<std::uint8_t>{7, 8, 9}, {}, {}});
  Notes notes;
  write_mesh(mesh, folder.path() / "a.off", &notes);
  EXPECT_EQ(notes, (Notes{"the array 'label' on vertices is not written: OFF cannot hold it",
                          "the array 'temperature' on vertices is not written: OFF cannot hold it",
                          "the array 'stress' on vertices is not written: OFF cannot hold it",
                          "the array 'label' on cells is not written: OFF cannot hold it",
                          "the array 'temperature' on cells is not written: OFF cannot hold it",
                          "the array 'stress' on cells is not written: OFF cannot hold it",
                          "the set 'fixed' of vertices is not written: OFF cannot hold it",
                          "the set 'part' of cells is not written: OFF cannot hold it",
                          "the ids of vertices are not written: OFF numbers them by position"}));
  const Mesh back = read_mesh(folder.path() / "a.off");
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(find_array(back, "color", Association::vertices)->values,
            Values(std::vector<std::int32_t>{1, 4, 7, 2, 5, 8, 3, 6, 9}));
}

TEST(Off, LeavesOutLinesThatOtherReadersDoNotTake) {
  const TemporaryFolder folder;
  const Mesh mesh = test::triangles_and_line(1);
  Notes notes;
  write_mesh(mesh, folder.path() / "a.off", &notes);
  EXPECT_EQ(notes, (Notes{"1 line is left out: OFF cannot hold it"}));
  EXPECT_NE(content_of(folder.path() / "a.off").find("3 1 0\n"), std::string::npos);
}

TEST(Off, RefusesVolumesAndCurvedCells) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.off";
  EXPECT_NE(write_error(tetrahedral_bar(1), path)
                .find("OFF cannot hold a cell of type tetrahedron; write .node, .veg"),
            std::string::npos);
  EXPECT_NE(write_error(cells_of_type(Shape::triangle, 6, 1), path).find("of type triangle6"),
            std::string::npos);
  EXPECT_NE(write_error(cells_of_type(Shape::triangle_strip, 5, 1), path).find("of type triangle_strip"),
            std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace meshorder
