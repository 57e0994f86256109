// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

namespace meshorder {
namespace {

using namespace test;

constexpr std::string_view kTwoSolids = R"(solid left part
facet normal 0 0 1
  outer loop
    vertex 0 0 0
    vertex 1 0 0
    vertex 0 1 0
  endloop
endfacet
facet normal 0 0 1
  outer loop
    vertex 1 0 0
    vertex 1 1 0
    vertex 0 1 0
  endloop
endfacet
endsolid left part
solid
facet normal 0 0 0
  outer loop
    vertex 0 0 0
    vertex 1 0 0
    vertex 0.1 0 0
  endloop
endfacet
endsolid
)";

/// A little-endian binary file, put together byte by byte.
struct Bytes {
  std::string text;
  void add(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    for (int i = 0; i < 4; ++i) text += static_cast<char>(bits >> 8 * i & 0xffU);
  }
  void triangle(std::initializer_list<float> numbers, int attribute) {
    for (const float x : numbers) add(x);
    text += static_cast<char>(attribute & 0xff);
    text += static_cast<char>(attribute >> 8);
  }
};

std::string binary_file(std::string header, float last = 2.5F) {
  header.resize(80, '\0');
  Bytes bytes{header + std::string("\2\0\0\0", 4)};
  bytes.triangle({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
  bytes.triangle({1, 0, 0, 1, 0, 0, 1, 1, 0, 1, 0, last}, 0x8102);
  return bytes.text;
}

/// The corners' coordinates of all triangles, in order: all that STL holds.
std::vector<Point> corners_of(const Mesh& mesh) {
  std::vector<Point> result;
  for (const Index v : mesh.cells.vertices) result.push_back(mesh.points[v]);
  return result;
}

TEST(Stl, JoinsEqualPointsByFirstAppearance) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.stl", kTwoSolids));
  EXPECT_EQ(mesh.points, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.1, 0, 0}}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 1, 3, 2, 0, 1, 4}));
  EXPECT_EQ(mesh.cell_blocks, (std::vector<Index>{0, 2}));
  EXPECT_EQ(find_array(mesh, kLabel, Association::cells)->values, Values(std::vector<std::int32_t>{1, 1, 2}));
}

TEST(Stl, ReadsFacetsWithoutNormals) {
  std::string without(kTwoSolids);
  for (const std::string_view normal : {" normal 0 0 1", " normal 0 0 1", " normal 0 0 0"}) {
    without.erase(without.find(normal), normal.size());
  }
  const TemporaryFolder folder;
  EXPECT_EQ(read_mesh(folder.file("a.stl", without)).cells,
            read_mesh(folder.file("b.stl", kTwoSolids)).cells);
}

TEST(Stl, TakesMinusZeroAsZeroButNothingElseAsEqual) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(
      folder.file("a.stl",
                  "SOLID\nFACET NORMAL nan -nan(ind) 0\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX -0.0 0 -0\n"
                  "VERTEX 5e-324 0 0\nENDLOOP\nENDFACET\nENDSOLID"));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 0, 1}));
}

TEST(Stl, WritesSolidsAsTheyStood) {
  const TemporaryFolder folder;
  Notes notes;
  write_mesh(read_mesh(folder.file("a.stl", kTwoSolids)), folder.path() / "b.stl", &notes);
  EXPECT_EQ(content_of(folder.path() / "b.stl"), kTwoSolids);
  EXPECT_EQ(notes, Notes{"STL has no vertex order: readers number vertices by first appearance and merge "
                         "equal points"});
}

TEST(Stl, KeepsEmptySolids) {
  const TemporaryFolder folder;
  std::string text = "solid empty\nendsolid empty\n";
  text += kTwoSolids;
  const Mesh mesh = read_mesh(folder.file("a.stl", text));
  EXPECT_EQ(mesh.cell_blocks, (std::vector<Index>{0, 2}));
  write_mesh(mesh, folder.path() / "b.stl");
  EXPECT_EQ(content_of(folder.path() / "b.stl"), text);
}

TEST(Stl, OrdersTrianglesAndPutsThemBack) {
  const TemporaryFolder folder;
  for (const std::string& text : {std::string(kTwoSolids), binary_file("made by a program")}) {
    const Mesh original = read_mesh(folder.file("a.stl", text));
    Mesh mesh = original;
    const Permutation cells = mesh.cell_blocks.empty() ? Permutation::from_old_to_new({1, 0})
                                                       : Permutation::from_old_to_new({1, 0, 2});
    apply_reordering(mesh, shuffled(mesh.vertex_count(), 1), cells);
    write_mesh(mesh, folder.path() / "b.stl");
    Mesh ordered = read_mesh(folder.path() / "b.stl");
    EXPECT_EQ(corners_of(ordered), corners_of(mesh));
    EXPECT_NE(corners_of(ordered), corners_of(original));
    EXPECT_EQ(ordered.data, mesh.data);
    apply_reordering(ordered, Permutation::identity(ordered.vertex_count()), cells.inverse());
    write_mesh(ordered, folder.path() / "c.stl");
    expect_same(read_mesh(folder.path() / "c.stl"), original);
  }
}

TEST(Stl, ReadsAndWritesBinaryWithItsHeaderAndAttributes) {
  const TemporaryFolder folder;
  for (const std::string header : {"made by a program", "solid but binary"}) {
    std::string text = binary_file(header);
    const Mesh mesh = read_mesh(folder.file("a.stl", text));
    EXPECT_EQ(mesh.points, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 2.5}}));
    EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 1, 3, 4}));
    ASSERT_EQ(mesh.data.size(), 1U);
    EXPECT_EQ(mesh.data[0],
              (DataArray{"attribute", Association::cells, 1, std::vector<std::uint16_t>{0, 0x8102}, {}, {}}));
    write_mesh(mesh, folder.path() / "b.stl");
    EXPECT_EQ(content_of(folder.path() / "b.stl"), text);
  }
}

TEST(Stl, ABinaryHeaderMayBeginAsAByteOrderMarkDoes) {
  const TemporaryFolder folder;
  std::string bytes = binary_file("");
  const Mesh plain = read_mesh(folder.file("a.stl", bytes));
  bytes.replace(0, 3, "\xEF\xBB\xBF");
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("b.stl", bytes), {.notes = &notes});
  EXPECT_EQ(mesh.points, plain.points);
  EXPECT_EQ(mesh.cells, plain.cells);
  EXPECT_TRUE(notes.empty()) << notes.front();
}

TEST(Stl, SaysWhenCoordinatesAreRounded) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.stl", binary_file("")));
  mesh.points[0][0] = 0.1;
  Notes notes;
  write_mesh(mesh, folder.path() / "b.stl", &notes);
  EXPECT_EQ(notes.front(), "coordinates are rounded to 32 bits, as binary STL has them");
  EXPECT_EQ(read_mesh(folder.path() / "b.stl").points[0][0], static_cast<double>(0.1F));
}

TEST(Stl, SaysWhenNormalsContradict) {
  const TemporaryFolder folder;
  std::string text(kTwoSolids);
  text.replace(text.find("0 0 1"), 5, "0 0 -1");
  Notes notes;
  (void)read_mesh(folder.file("a.stl", text), {.notes = &notes});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("the normals of 1 triangles"), std::string::npos);
}

TEST(Stl, ReadsEndsInTwoWords) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.stl", kTwoSolids));
  for (const char* const part : {"loop", "facet", "solid"}) {
    std::string text(kTwoSolids);
    const std::string one = std::string("end") + part;
    for (auto at = text.find(one); at != std::string::npos; at = text.find(one, at)) {
      text.replace(at, one.size(), std::string("END ") + part);
    }
    const Mesh read = read_mesh(folder.file("b.stl", text));
    EXPECT_EQ(read.points, mesh.points) << part;
    EXPECT_EQ(read.cells, mesh.cells) << part;
    EXPECT_EQ(read.data, mesh.data) << part;
  }
}

TEST(Stl, ReadsBinaryFilesToTheirEndWhateverTheirCount) {
  const TemporaryFolder folder;
  const std::string binary = binary_file("");
  const Mesh mesh = read_mesh(folder.file("a.stl", binary));
  const auto notes_on = [&](const std::string& content) {
    Notes notes;
    EXPECT_EQ(read_mesh(folder.file("b.stl", content), {.notes = &notes}).cells, mesh.cells);
    return notes;
  };
  std::string none = binary;
  none[80] = '\0';
  EXPECT_EQ(notes_on(none), (Notes{"the file has 2 triangles, though its count says 0; all are read"}));
  EXPECT_EQ(notes_on(binary + "\r\n"), (Notes{"the 2 bytes after the last triangle are left out"}));
}

TEST(Stl, BrokenFilesStopWithTheirPlace) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const std::string binary = binary_file("");
  const std::string huge = std::string(80, '\0') + std::string("\xff\xff\xff\xff", 4);
  expect_broken(
      "a.stl",
      {{"garbage", "\x7f\x45\x4c\x46 garbage", "is not an STL file"},
       {"long garbage", std::string(200, '\xfe'), "is not an STL file"},
       {"zero triangles", "solid\nendsolid\n", "has no cells"},
       {"zero binary triangles", "cube" + std::string(80, '\0'), "has no cells"},
       {"only solid", "solid a\n", ":2: unexpected end of file; expected 'facet'"},
       {"no endsolid", "solid a\n" + facet, ":9: unexpected end of file; expected 'facet'"},
       {"facet without solid", facet, "is not an STL file"},
       {"text after", "solid a\n" + facet + "endsolid\nhello\n", ":10: 'solid' is missing"},
       {"two vertices", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
        ":6: 'vertex' is missing"},
       {"four vertices",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 "
        "0\nendloop\n",
        ":7: 'endloop' is missing"},
       {"two coordinates", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nvertex 1 0 0\n",
        ":5: a coordinate is 'vertex'"},
       {"no normal", "solid a\nfacet\nnorm 0 0 1\n", ":3: 'normal' is missing"},
       {"nan", "solid a\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\n", ":4: a coordinate is not finite"},
       {"infinite", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 inf 0\n",
        ":4: a coordinate is not finite"},
       {"no number", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 x 0\n", ":4: a coordinate is 'x'"},
       {"binary cut", binary.substr(0, 150),
        "byte 80: a binary STL file of 2 triangles has 184 bytes, this one has 150"},
       {"binary header cut", "cube" + std::string(46, '\0'), "is not an STL file"},
       {"absurd count", huge, "byte 80: a binary STL file of 4294967295 triangles"},
       {"binary solid cut", binary_file("solid").substr(0, 100), "byte 80: a binary STL file of 2"},
       {"binary nan", binary_file("", std::numeric_limits<float>::quiet_NaN()),
        "byte 182: a coordinate is not finite"},
       {"binary infinite", binary_file("", std::numeric_limits<float>::infinity()),
        "byte 182: a coordinate is not finite"}});
}

TEST(Stl, NoticesTruncation) {
  // the loss of a whole solid cannot be noticed
  const std::size_t one_solid = kTwoSolids.find("solid\n");
  expect_truncation_is_noticed("a.stl", kTwoSolids.substr(0, one_solid));
  expect_truncation_is_noticed("a.stl", binary_file("x"));
}

TEST(Stl, WritesOtherMeshesAsTextWithASolidForEachLabel) {
  const TemporaryFolder folder;
  Mesh mesh = cells_of_type(Shape::triangle, 3, 4);
  mesh.points.push_back({9, 9, 9});
  mesh.data.erase(mesh.data.begin(), mesh.data.begin() + 3);
  mesh.cell_ids = {2, 3, 4, 5};
  Notes notes;
  write_mesh(mesh, folder.path() / "a.stl", &notes);
  EXPECT_EQ(notes, (Notes{"STL has no vertex order: readers number vertices by first appearance and merge "
                          "equal points",
                          "vertices without cells are not written: 1",
                          "the array 'temperature' on cells is not written: STL cannot hold it",
                          "the array 'stress' on cells is not written: STL cannot hold it",
                          "the set 'fixed' of vertices is not written: STL cannot hold it",
                          "the set 'part' of cells is not written: STL cannot hold it",
                          "the ids of cells are not written: STL numbers them by position"}));
  const Mesh back = read_mesh(folder.path() / "a.stl");
  const Permutation by_label = Permutation::from_new_to_old({0, 3, 1, 2});  // labels 1 2 3 1
  apply_reordering(mesh, Permutation::identity(mesh.vertex_count()), by_label);
  EXPECT_EQ(corners_of(back), corners_of(mesh));
  EXPECT_EQ(find_array(back, kLabel, Association::cells)->values,
            find_array(mesh, kLabel, Association::cells)->values);
}

TEST(Stl, RefusesOtherCells) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.stl";
  EXPECT_NE(write_error(cells_of_type(Shape::quad, 4, 1), path).find("STL cannot hold a cell of type quad"),
            std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace meshorder
