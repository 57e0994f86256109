// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

namespace meshorder {
namespace {

using namespace test;

constexpr std::string_view kRich = R"(ply
format ascii 1.0
comment made by hand
obj_info a number 7
element vertex 5
property float x
property float y
property float z
property float nx
property uchar red
property list uchar float weights
element face 3
property list uchar int vertex_indices
property list uchar float texcoord
property uchar red
property int part
element edge 2
property int vertex1
property int vertex2
property uchar red
element material 1
property uchar ambient_red
property float shine
end_header
0 0 0 0.5 1 0
1 0 0 0.25 2 1 0.5
1 1 0 0.125 3 2 0.5 0.75
0 1 0 -1 4 0
0.5 1.5 0.1 1e-09 5 1 0.125
4 0 1 2 3 2 0 1 10 -1
3 2 4 3 0 20 2
3 0 4 1 2 0.5 0.25 30 3
0 4 40
1 4 50
200 0.5
)";

TEST(Ply, ReadsElementsAndTheirProperties) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.ply", kRich));
  EXPECT_EQ(mesh.points[4], (Point{0.5, 1.5, 0.1}));
  EXPECT_EQ(mesh.cells.shapes,
            (std::vector{Shape::quad, Shape::triangle, Shape::triangle, Shape::line, Shape::line}));
  EXPECT_EQ(mesh.cell_blocks, (std::vector<Index>{0, 3}));
  const std::vector<DataArray> expected{
      {"nx", Association::vertices, 1, std::vector<float>{0.5F, 0.25F, 0.125F, -1, 1e-9F}, {}, {}},
      {"red", Association::vertices, 1, std::vector<std::uint8_t>{1, 2, 3, 4, 5}, {}, {}},
      {"weights", Association::vertices, 1, std::vector<float>{0.5F, 0.125F}, {1, 4}, {}},
      {"weights", Association::vertices, 2, std::vector<float>{0.5F, 0.75F}, {2}, {}},
      {"texcoord", Association::cells, 2, std::vector<float>{0, 1, 0.5F, 0.25F}, {0, 2}, {}},
      {"red", Association::cells, 1, std::vector<std::uint8_t>{10, 20, 30, 40, 50}, {}, {}},
      {"part", Association::cells, 1, std::vector<std::int32_t>{-1, 2, 3}, {0, 1, 2}, {}}};
  EXPECT_EQ(mesh.data, expected);
}

TEST(Ply, OrdersAndPutsBackEverything) {
  expect_order_and_back_to("a.ply", kRich);
  const TemporaryFolder folder;
  Notes notes;
  write_mesh(read_mesh(folder.file("a.ply", kRich)), folder.path() / "b.ply", &notes);
  EXPECT_EQ(content_of(folder.path() / "b.ply"), kRich);
  EXPECT_TRUE(notes.empty());
}

/// One triangle in binary, put together byte by byte.
std::string binary_triangle(std::endian order, float last = 0.1F, std::int32_t corner = 2) {
  const bool big = order == std::endian::big;
  std::string text =
      std::string("ply\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\nelement vertex 3\nproperty double x\nproperty float32 y\nproperty float z\n"
      "property short level\nelement face 1\nproperty list uint8 int32 vertex_index\n"
      "element camera 1\nproperty int viewportx\nproperty float scale\nend_header\n";
  const auto add = [&](auto value) {
    std::array<char, sizeof(value)> raw{};
    std::memcpy(raw.data(), &value, sizeof(value));
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    text.append(raw.data(), raw.size());
  };
  for (int v = 0; v < 3; ++v) {
    add(v + 0.1);
    add(v == 1 ? 2.5F : 0.0F);
    add(v == 2 ? last : 0.0F);
    add(static_cast<std::int16_t>(-v * 300));
  }
  text += '\3';
  for (const std::int32_t v : {0, 1, corner}) add(v);
  add(std::int32_t{640});
  add(1.5F);
  return text;
}

TEST(Ply, ReadsAndWritesBothByteOrders) {
  const TemporaryFolder folder;
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string text = binary_triangle(order);
    const Mesh mesh = read_mesh(folder.file("a.ply", text));
    EXPECT_EQ(mesh.points, (std::vector<Point>{{0.1, 0, 0}, {1.1, 2.5, 0}, {2.1, 0, double{0.1F}}}));
    EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2}));
    ASSERT_EQ(mesh.data.size(), 1U);
    EXPECT_EQ(mesh.data[0].values, Values(std::vector<std::int16_t>{0, -300, -600}));
    expect_order_and_back_to("a.ply", text);
  }
}

TEST(Ply, KeepsZeroBytesAtTheEndOfBinaryData) {
  const std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n"
      "property uchar z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n"
      "\1\1\1\2\1\1\1\2\1\3\1\2";
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.ply", text + '\0'));  // the last vertex of the face
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{1, 2, 0}));
}

TEST(Ply, TakesHeadersWithEveryLineEnd) {
  const TemporaryFolder folder;
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    SCOPED_TRACE(static_cast<int>(end[0]));
    std::string header;
    for (const std::string line :
         {"ply", "format binary_little_endian 1.0", "element vertex 1", "property uchar x",
          "property uchar y", "property uchar z", "element face 1",
          "property list uchar uchar vertex_indices", "end_header"}) {
      header += line + end;
    }
    const Mesh mesh = read_mesh(folder.file("a.ply", header + "\n\1\2\1" + std::string(1, '\0')));
    EXPECT_EQ(mesh.points, (std::vector<Point>{{10, 1, 2}}));
    EXPECT_EQ(mesh.cells.shapes, std::vector{Shape::vertex});
  }
}

TEST(Ply, ReadsTetrahedra) {
  expect_order_and_back_to(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\n"
      "property double z\nelement face 2\nproperty list uchar uint vertex_indices\n"
      "element tetra 2\nproperty list uchar uint vertex_indices\nproperty float q\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n3 0 2 1\n3 0 1 3\n4 0 1 2 3 0.5\n4 4 1 2 3 0.75\n");
}

TEST(Ply, WidensIndicesThatReorderingMakesTooLarge) {
  const TemporaryFolder folder;
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 300\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  for (int v = 0; v < 300; ++v) text += std::to_string(v) + " 0 0\n";
  Mesh mesh = read_mesh(folder.file("a.ply", text + "3 0 1 2\n"));
  std::vector<Index> reverse(300);
  for (Index v = 0; v < 300; ++v) reverse[v] = 299 - v;
  apply_reordering(mesh, Permutation::from_old_to_new(reverse), Permutation::identity(1));
  write_mesh(mesh, folder.path() / "b.ply");
  expect_same(read_mesh(folder.path() / "b.ply"), mesh);
}

constexpr std::string_view kTextured = R"(ply
format ascii 1.0
comment TextureFile skin.png
element vertex 5
property float x
property float y
property float z
element face 3
property list uchar int vertex_indices
element multi_texture_vertex 5
property uchar tx
property float u
property float v
element multi_texture_face 3
property uchar tx
property uint tn
property list uchar int texture_vertex_indices
element material 3
property int ambient_coeff
element patch 2
property int size
end_header
0 0 0
1 0 0
1 1 0
0 1 0
2 2 2
3 0 1 2
3 0 2 3
3 2 3 4
0 0 0
0 1 0
0 1 1
0 0 1
0 0.5 0.5
0 0 3 0 1 2
1 1 3 0 2 3
2 2 3 2 3 4
1
2
3
70
80
)";

TEST(Ply, RowsOfTexturesFollowTheirFaces) {
  expect_order_and_back_to("a.ply", kTextured);
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.ply", kTextured));
  apply_reordering(mesh, Permutation::identity(5), Permutation::from_old_to_new({2, 0, 1}));
  Notes notes;
  write_mesh(mesh, folder.path() / "b.ply", &notes);
  EXPECT_EQ(notes, Notes{});
  // the second number of a row is the number of its face
  std::string expected(kTextured);
  const auto swap = [&](const std::string& old, const std::string& fresh) {
    expected.replace(expected.find(old), old.size(), fresh);
  };
  swap("3 0 1 2\n3 0 2 3\n3 2 3 4\n", "3 0 2 3\n3 2 3 4\n3 0 1 2\n");
  swap("0 0 3 0 1 2\n1 1 3 0 2 3\n2 2 3 2 3 4\n", "1 0 3 0 2 3\n2 1 3 2 3 4\n0 2 3 0 1 2\n");
  EXPECT_EQ(content_of(folder.path() / "b.ply"), expected);
}

TEST(Ply, LeavesOutWhatMayNameVerticesOrFaces) {
  struct Doubt {
    const char* what;
    std::string header;  ///< lines of properties and elements after the list of a face's vertices
    std::string face;    ///< text after the vertices of the first face
    std::string rows;    ///< lines of the elements
    std::string note;
  };
  const TemporaryFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string vertices = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  const std::string whole = "holds whole numbers, which could be those of vertices or faces";
  for (const Doubt& doubt : std::vector<Doubt>{
           {"a list of faces", "property list uchar int neighbours\n", " 2 7 8", "",
            "not written: the property 'neighbours' of the element face, which " + whole},
           {"lists of an element", "element patch 1\nproperty list uchar int corners\n", "", "2 0 1\n",
            "not written: the element 'patch': its property 'corners' " + whole},
           {"numbers of vertices", "element pin 2\nproperty int vertex\n", "", "0\n1\n",
            "not written: the element 'pin': its property 'vertex' " + whole},
           {"as many rows as vertices", "element quality 3\nproperty float q\n", "", "0.5\n1\n2\n",
            "not written: the element 'quality': it has as many rows as the element vertex, to which they "
            "could "
            "belong"}}) {
    SCOPED_TRACE(doubt.what);
    const Mesh mesh =
        read_mesh(folder.file("a.ply", head + doubt.header + vertices + doubt.face + "\n" + doubt.rows));
    Notes notes;
    write_mesh(mesh, folder.path() / "b.ply", &notes);
    EXPECT_EQ(notes, Notes{doubt.note});
    EXPECT_EQ(content_of(folder.path() / "b.ply"), head + vertices + "\n");
    EXPECT_THROW(write_mesh(mesh, folder.path() / "c.ply", WriteOptions{.strict = true}), InputError);
  }
}

TEST(Ply, TriangleStripsBecomeTriangles) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  const TemporaryFolder folder;
  Notes notes;
  // two strips; the second repeats a corner, which reverses it
  const Mesh mesh = read_mesh(folder.file("a.ply", head + "10 0 1 2 3 -1 3 2 2 5 4\n"), {.notes = &notes});
  EXPECT_EQ(notes, (Notes{"the triangle strips became 3 triangles, which are written as faces"}));
  EXPECT_EQ(mesh.cells.shapes, (std::vector<Shape>(3, Shape::triangle)));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 2, 1, 3, 2, 5, 4}));
  write_mesh(mesh, folder.path() / "b.ply", &notes);
  EXPECT_NE(
      content_of(folder.path() / "b.ply").find("element face 3\nproperty list uchar int vertex_indices\n"),
      std::string::npos);
  expect_same(read_mesh(folder.path() / "b.ply"), mesh);
  EXPECT_NE(read_error(folder.file("c.ply", head + "4 0 1 2 9\n")).find(":16: vertex 9 does not exist"),
            std::string::npos);
}

TEST(Ply, BrokenFilesStopWithTheirPlace) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string ascii = "ply\nformat ascii 1.0\n";
  const std::string faces = "property list uchar int vertex_indices\n";
  const std::string head =
      ascii + "element vertex 3\n" + xyz + "element face 1\n" + faces + "end_header\n";  // 9 lines
  const std::string vertices = head + "0 0 0\n1 0 0\n0 1 0\n";
  const auto with_vertex = [&](const std::string& property) {
    return ascii + "element vertex 1\n" + xyz + property + "\nelement face 1\n" + faces +
           "end_header\n0 0 0 0\n1 0\n";
  };
  const auto with_element = [&](const std::string& element) {
    return ascii + "element vertex 1\n" + xyz + "element face 1\n" + faces + element +
           "end_header\n0 0 0\n1 0\n1 1\n";
  };
  const std::string binary = binary_triangle(std::endian::little);
  expect_broken(
      "a.ply",
      {{"garbage", "\x7f\x45\x4c\x46", ":1: the file does not begin with 'ply'"},
       {"only ply", "ply\n", ":2: unexpected end of file in the header"},
       {"no format", "ply\nend_header\n", ":2: the header has no format"},
       {"unknown format", "ply\nformat xml 1.0\n", ":2: the encoding 'xml' is unknown"},
       {"unknown version", "ply\nformat ascii 2.0\n", ":2: the version of the format is unknown"},
       {"unknown word", ascii + "elements vertex 3\n", ":3: 'elements vertex 3' is not a header line"},
       {"unknown type", ascii + "element vertex 1\nproperty real x\n", ":4: the type 'real' is unknown"},
       {"property first", ascii + "property float x\n", ":3: 'property float x' is not a header line"},
       {"real list count", ascii + "element face 1\nproperty list float int vertex_indices\n",
        ":4: the length of a list is not an integer"},
       {"no end_header", head.substr(0, head.find("end_header")), "unexpected end of file in the header"},
       {"no vertices", ascii + "element face 1\n" + faces + "end_header\n1 0\n",
        ":5: the header has no element vertex"},
       {"no z", ascii + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
        "lacks x, y or z"},
       {"no list",
        ascii + "element vertex 1\n" + xyz + "element face 1\nproperty int a\nend_header\n0 0 0\n1\n",
        "the element face has no list vertex_indices"},
       {"two lists of corners",
        ascii + "element vertex 1\n" + xyz + "element face 1\n" + faces +
            "property list uchar int vertex_index\nend_header\n0 0 0\n1 0 1 0\n",
        "the element face has both vertex_indices and vertex_index"},
       {"edges without ends", with_element("element edge 1\nproperty int vertex1\nproperty float a\n"),
        "the element edge has no whole numbers vertex1"},
       {"property twice", with_vertex("property float x"), "has two properties 'x'"},
       {"faces and strips", with_element("element tristrips 1\nproperty list int int vertex_indices\n"),
        ":11: the header has the elements face and tristrips"},
       {"strip without corners",
        ascii + "element vertex 1\n" + xyz + "element tristrips 1\nproperty float a\nend_header\n0 0 0\n1\n",
        "the element tristrips has no list vertex_indices"},
       {"10^12 vertices", ascii + "element vertex 1000000000000\n" + xyz,
        ":3: the number of vertex is 1000000000000"},
       {"negative vertices", ascii + "element vertex -1\n" + xyz, ":3: the number of vertex is -1"},
       {"count no number", ascii + "element vertex many\n" + xyz, ":3: the number of an element is 'many'"},
       {"more than fits",
        ascii + "element vertex 100\n" + xyz + "element face 1\n" + faces + "end_header\n0 0 0\n1 0 0\n",
        "the number of vertex is 100, but only"},
       {"zero faces", ascii + "element vertex 1\n" + xyz + "end_header\n0 0 0\n", "has no cells"},
       {"no data", head, "the number of vertex is 3, but only 0 bytes"},
       {"a vertex too few", head + "0 0 0\n1 0 0\n3 0 1 2\n",
        ":12: the list vertex_indices has the length 2"},
       {"a vertex too many", vertices + "0 0 1\n3 0 1 2\n", ":13: a face has no vertices"},
       {"a face too many", vertices + "3 0 1 2\n3 0 1 2\n", ":14: unexpected data after"},
       {"nan", head + "0 nan 0\n1 0 0\n0 1 0\n3 0 1 2\n", ":10: a coordinate is not finite"},
       {"infinite", head + "0 0 0\n1 -inf 0\n0 1 0\n3 0 1 2\n", ":11: a coordinate is not finite"},
       {"no number", head + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", ":11: a coordinate is 'x'"},
       {"index too large", vertices + "3 0 1 3\n",
        ":13: vertex 3 does not exist; there are 3, counted from 0"},
       {"index negative", vertices + "3 0 1 -1\n", ":13: vertex -1 does not exist"},
       {"index real", vertices + "3 0 1 1.5\n", ":13: a vertex is '1.5'"},
       {"empty face", vertices + "0 0 1 2\n", ":13: a face has no vertices"},
       {"absurd face", vertices + "200 0 1 2\n", ":13: the list vertex_indices has the length 200"},
       {"face count too wide", vertices + "300 0 1 2\n",
        ":13: the length of a list is 300; the property's type cannot hold it"},
       {"face cut", vertices + "3 0 1\n", "unexpected end of file; expected a vertex"},
       {"byte too large",
        with_vertex("property uchar red")
            .replace(with_vertex("property uchar red").find("0 0 0 0"), 7, "0 0 0 999"),
        "red is 999; the property's type cannot hold it"},
       {"tetrahedron of three", with_element("element tetra 1\nproperty list uchar int vertex_indices\n"),
        "a tetrahedron has 1 vertices"},
       {"binary cut", binary.substr(0, binary.size() - 1), "byte 325: unexpected end of file in scale"},
       {"binary vertices cut", binary.substr(0, binary.size() - 40), "the number of vertex is 3"},
       {"binary too long", binary + "x", "byte 329: unexpected data after"},
       {"binary nan", binary_triangle(std::endian::big, std::numeric_limits<float>::quiet_NaN()),
        "byte 303: a coordinate is not finite"},
       {"binary index", binary_triangle(std::endian::little, 0.1F, 3), "byte 321: vertex 3 does not exist"}});
}

TEST(Ply, NoticesTruncation) {
  expect_truncation_is_noticed("a.ply", kRich);
  expect_truncation_is_noticed("a.ply", binary_triangle(std::endian::big));
}

TEST(Ply, WritesAndReadsItsTypes) {
  for (const auto& [shape, width] : std::vector<std::pair<Shape, int>>{{Shape::vertex, 1},
                                                                       {Shape::line, 2},
                                                                       {Shape::triangle, 3},
                                                                       {Shape::quad, 4},
                                                                       {Shape::polygon, 300},
                                                                       {Shape::tetrahedron, 4}}) {
    Mesh mesh = cells_of_type(shape, width, 5);
    mesh.sets.clear();
    mesh.format = "ply";
    expect_write_and_read(mesh, "a.ply");
  }
}

TEST(Ply, WritesOtherMeshesExactlySo) {
  const TemporaryFolder folder;
  Mesh mesh;
  mesh.points = {{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.format = "ply";  // other meshes' lines are left out
  mesh.cells.push_back(Shape::line, std::vector<Index>{0, 1});
  mesh.cells.push_back(Shape::triangle, std::vector<Index>{0, 1, 2});
  mesh.data.push_back(
      {"color", Association::vertices, 3, std::vector<std::int32_t>{1, 2, 3, 4, 5, 6, 7, 8, 255}, {}, {}});
  mesh.data.push_back({"my label", Association::cells, 1, std::vector<std::int64_t>{-7, 8}, {}, {}});
  mesh.data.push_back({"words", Association::cells, 1, std::vector<std::string>{"a", "b"}, {}, {}});
  mesh.data.push_back({"pair", Association::cells, 2, std::vector<double>{0.5, 1}, {1}, {}});
  mesh.sets.push_back({"part", Association::cells, {0}});
  Notes notes;
  write_mesh(mesh, folder.path() / "a.ply", &notes);
  const std::string text = content_of(folder.path() / "a.ply");
  EXPECT_EQ(
      text.substr(0, text.find("end_header")),
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty int my_label\nproperty list uchar double pair\n"
      "element edge 1\nproperty int vertex1\nproperty int vertex2\nproperty int my_label\n");
  EXPECT_EQ(notes, (Notes{"the array 'my label' is written as 'my_label'",
                          "the array 'words' on cells is not written: PLY cannot hold it",
                          "the set 'part' of cells is not written: PLY cannot hold it"}));
  const Mesh back = read_mesh(folder.path() / "a.ply");
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells.vertices, (std::vector<Index>{0, 1, 2, 0, 1}));
  EXPECT_EQ(find_array(back, "green", Association::vertices)->values,
            Values(std::vector<std::uint8_t>{2, 5, 8}));
  EXPECT_EQ(find_array(back, "my_label", Association::cells)->values,
            Values(std::vector<std::int32_t>{8, -7}));
  EXPECT_EQ(*find_array(back, "pair", Association::cells),
            (DataArray{"pair", Association::cells, 2, std::vector<double>{0.5, 1}, {0}, {}}));
}

TEST(Ply, SaysWhichWholeNumbersLoseDigits) {
  const TemporaryFolder folder;
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.cells.push_back(Shape::triangle, std::vector<Index>{0, 1, 2});
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  mesh.data.push_back({"exact", Association::cells, 1, std::vector<std::int64_t>{kExact}, {}, {}});
  mesh.data.push_back({"large", Association::cells, 1, std::vector<std::int64_t>{kExact + 1}, {}, {}});
  Notes notes;
  write_mesh(mesh, folder.path() / "a.ply", &notes);
  EXPECT_EQ(notes, (Notes{"the array 'large' loses digits: PLY has no whole numbers of 64 bits"}));
}

TEST(Ply, LeavesOutWhatOtherReadersDoNotFind) {
  const TemporaryFolder folder;
  const Mesh mesh = test::triangles_and_line(2);
  Notes notes;
  write_mesh(mesh, folder.path() / "a.ply", &notes);
  EXPECT_EQ(notes, (Notes{"1 line is left out: PLY cannot hold it"}));
  EXPECT_EQ(content_of(folder.path() / "a.ply").find("edge"), std::string::npos);
  EXPECT_NE(write_error(tetrahedral_bar(1), folder.path() / "b.ply")
                .find("PLY cannot hold a cell of type tetrahedron"),
            std::string::npos);
}

TEST(Ply, RefusesPolygonsThatWouldComeBackAsLines) {
  const TemporaryFolder folder;
  for (const int width : {1, 2}) {
    EXPECT_NE(write_error(cells_of_type(Shape::polygon, width, 1), folder.path() / "a.ply")
                  .find("PLY cannot hold a cell of type polygon"),
              std::string::npos);
  }
}

TEST(Ply, RefusesOtherCells) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.ply";
  EXPECT_NE(write_error(cells_of_type(Shape::hexahedron, 8, 1), path)
                .find("PLY cannot hold a cell of type hexahedron"),
            std::string::npos);
  EXPECT_NE(write_error(cells_of_type(Shape::triangle, 6, 1), path).find("of type triangle6"),
            std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace meshorder
