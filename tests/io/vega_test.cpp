// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace meshorder {
namespace {

using namespace test;

constexpr std::string_view kTwoTets = R"(# two tetrahedra
*VERTICES
5 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1.5 1 1e-3

# the elements
*ELEMENTS
TETS
2 4 0
1 1 2 3 4
2 5 3 2 4

*MATERIAL soft
ENU, 1000, 25000, 0.45

*MATERIAL hard
MOONEYRIVLIN, 1000, 1, 2, 3

# one element
*SET upper
2

*SET none

*REGION
allElements, soft

*REGION
upper, hard

# the end
)";

TEST(Vega, ReadsElementsSetsAndRegions) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.veg", kTwoTets));
  EXPECT_EQ(mesh.points[4], (Point{1.5, 1, 1e-3}));
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::tetrahedron, Shape::tetrahedron}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 3, 4, 2, 1, 3}));
  ASSERT_EQ(mesh.sets.size(), 2U);
  EXPECT_EQ(mesh.sets[0], (EntitySet{"upper", Association::cells, {1}}));
  EXPECT_EQ(mesh.sets[1], (EntitySet{"none", Association::cells, {}}));
  EXPECT_EQ(find_array(mesh, kLabel, Association::cells)->values, Values(std::vector<std::int32_t>{1, 2}));
  EXPECT_TRUE(mesh.vertex_ids.empty());
  EXPECT_TRUE(mesh.cell_ids.empty());
}

TEST(Vega, WritesEverySectionBackAsItStood) {
  const TemporaryFolder folder;
  Notes notes;
  write_mesh(read_mesh(folder.file("a.veg", kTwoTets)), folder.path() / "b.veg", &notes);
  std::string expected(kTwoTets);
  expected.replace(expected.find("1e-3"), 4, "0.001");
  EXPECT_EQ(content_of(folder.path() / "b.veg"), expected);
  EXPECT_TRUE(notes.empty());
}

TEST(Vega, MovesSetsWithTheirElements) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.veg", kTwoTets));
  apply_reordering(mesh, Permutation::from_old_to_new({4, 3, 2, 1, 0}), Permutation::from_old_to_new({1, 0}));
  write_mesh(mesh, folder.path() / "b.veg");
  const std::string text = content_of(folder.path() / "b.veg");
  EXPECT_NE(text.find("*SET upper\n1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n1 1 3 4 2\n2 5 4 3 2\n"), std::string::npos) << text;
  EXPECT_NE(text.find("*REGION\nupper, hard\n"), std::string::npos) << text;
}

TEST(Vega, TakesNumbersFromZeroCommasAnyCaseAndMixedLineEnds) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.veg",
                                          "*vertices\r\n4,3,0,0\r0,0,0,0\n1, 1,0,0 # corner\n2 0 1 0\r\n"
                                          "3 0 0 1\n*Elements\nTET\n1 4 0\n0 0 1 2 3\n*set a\n0"));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_TRUE(mesh.vertex_ids.empty());
  write_mesh(mesh, folder.path() / "b.veg");
  EXPECT_EQ(content_of(folder.path() / "b.veg"),
            "*VERTICES\n4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n\n"
            "*ELEMENTS\nTET\n1 4 0\n0 0 1 2 3\n\n*SET a\n0\n\n");
}

TEST(Vega, NumbersWithGapsRunInTheNewOrderOfWhatMoves) {
  const TemporaryFolder folder;
  Notes notes;
  Mesh mesh = read_mesh(folder.file("a.veg",
                                    "*VERTICES\n4 3 0 0\n9000000000 0 0 0\n7 1 0 0\n20 0 1 0\n3 0 0 1\n"
                                    "*ELEMENTS\nTET\n2 4 0\n50 9000000000 7 20 3\n40 7 9000000000 20 3\n"
                                    "*SET a\n50\n"),
                        {.notes = &notes});
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 3, 1, 0, 2, 3}));
  EXPECT_EQ(mesh.sets[0].members, std::vector<Index>{0});
  EXPECT_EQ(notes.size(), 1U);
  apply_reordering(mesh, Permutation::from_old_to_new({1, 0, 2, 3}), Permutation::identity(2));
  write_mesh(mesh, folder.path() / "b.veg");
  EXPECT_EQ(content_of(folder.path() / "b.veg"),
            "*VERTICES\n4 3 0 0\n3 1 0 0\n7 0 0 0\n20 0 1 0\n9000000000 0 0 1\n\n"
            "*ELEMENTS\nTET\n2 4 0\n50 7 3 20 9000000000\n40 3 7 20 9000000000\n\n*SET a\n50\n\n");
}

TEST(Vega, ReadsPlainLinesAndOthersAlike) {
  const TemporaryFolder folder;
  const Mesh expected = read_mesh(folder.file("a.veg", kTwoTets));
  const std::string text(kTwoTets);
  for (const std::string& other :
       {with(text, "2 1 0 0\n", "2, 1, 0, 0\n"), with(text, "2 1 0 0\n", "# here\n2 1 0 0 # one\n"),
        with(text, "5 3 0 0\n", "5 3\n"), with(text, "2 5 3 2 4\n", "2 5,3 2\v4\n"),
        with(with(text, "1 1 2 3 4\n", "7 1 2 3 4\n"), "upper\n2", "upper\n2 # not 7")}) {
    const Mesh mesh = read_mesh(folder.file("a.veg", other));
    EXPECT_EQ(mesh.points, expected.points) << other;
    EXPECT_EQ(mesh.cells.vertices, expected.cells.vertices) << other;
    EXPECT_EQ(mesh.cells.offsets, expected.cells.offsets) << other;
    EXPECT_EQ(mesh.sets[0].members, expected.sets[0].members) << other;
  }
  expect_broken("a.veg", {{"an unknown vertex", with(text, "2 5 3 2 4", "2 6 3 2 4"), ":15:"}});
}

TEST(Vega, KeepsAttributesAndMarkersOfIncludedTetgenFiles) {
  const TemporaryFolder folder;
  (void)folder.file("a.node",
                    "# TetGen\n4 3 1 1\n1 0 0 0 0.5 7\n2 1 0 0 1.5 8\n3 0 1 0 2.5 9\n4 0 0 1 3.5 10\n");
  (void)folder.file("a.ele", "1 4 1\n1 1 2 3 4 17\n");
  const Mesh mesh =
      read_mesh(folder.file("a.veg", "*VERTICES\n*INCLUDE a.node\n*ELEMENTS\nTET\n*INCLUDE a.ele\n"));
  EXPECT_EQ(find_array(mesh, "attributes", Association::vertices)->values,
            Values(std::vector{0.5, 1.5, 2.5, 3.5}));
  EXPECT_EQ(find_array(mesh, kLabel, Association::vertices)->values,
            Values(std::vector<std::int32_t>{7, 8, 9, 10}));
  EXPECT_EQ(find_array(mesh, "attributes", Association::cells)->values, Values(std::vector{17.0}));
  Notes notes;
  write_mesh(mesh, folder.path() / "b.veg", &notes);
  EXPECT_EQ(notes, (Notes{"the file 'a.node', which was included, is written inline",
                          "the file 'a.ele', which was included, is written inline"}));
  expect_same(read_mesh(folder.path() / "b.veg"), mesh);
}

TEST(Vega, ReadsNestedIncludesFromTheFolderOfEach) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  (void)folder.file("sub/list.txt", "*INCLUDE rest.txt\n1\n");
  (void)folder.file("sub/rest.txt", "2,\n");
  (void)folder.file("empty.txt", "");
  std::string text(kTwoTets);
  text.replace(text.find("2\n\n*SET none"), 2, "*include sub/list.txt\n*INCLUDE empty.txt\n");
  const Mesh mesh = read_mesh(folder.file("a.veg", text));
  EXPECT_EQ(mesh.sets[0].members, (std::vector<Index>{1, 0}));
}

TEST(Vega, NamesFileAndLineOfIncludesThatFail) {
  const TemporaryFolder folder;
  const auto error_with = [&](std::string_view list) {
    std::string text(kTwoTets);
    (void)folder.file("list.txt", list);
    text.replace(text.find("2\n\n*SET none"), 2, "*INCLUDE list.txt\n");
    return read_error(folder.file("a.veg", text));
  };
  const std::string folder_name = folder.path().string();
  EXPECT_EQ(
      error_with("1\n*INCLUDE none.txt\n"),
      folder_name + "/list.txt:2: the included file 'none.txt' does not exist; put it beside this file");
  EXPECT_EQ(error_with("1\n3\n").find(folder_name + "/list.txt:2: element 3 does not exist"), 0U);
  EXPECT_NE(error_with("*INCLUDE a.veg\n").find("list.txt:1: the included file 'a.veg' includes itself"),
            std::string::npos);
}

TEST(Vega, BrokenFilesStopWithTheirLine) {
  const std::string vertices = "*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
  const std::string elements = vertices + "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n";
  expect_broken(
      "a.veg",
      {{"garbage", "\x7f\x45\x4c\x46 garbage\n", ":1: a section must begin here"},
       {"binary", std::string("\0\0\0\0\0\0\xf0\x3f\1\0\0\0", 12), "is a binary Vega file"},
       {"only comments", "# nothing\n", "the file has no *VERTICES"},
       {"no elements", vertices, "the file has no *ELEMENTS"},
       {"zero cells", vertices + "*ELEMENTS\nTET\n0 4 0\n", "has no cells"},
       {"text before sections", "hello\n" + elements, ":1: a section must begin here"},
       {"a vertex too few", "*VERTICES\n3 3 0 0\n1 0 0 0\n2 1 0 0\n*ELEMENTS\n", ":5: expected vertex 3"},
       {"a vertex too many", "*VERTICES\n1 3 0 0\n1 0 0 0\n2 1 0 0\n*ELEMENTS\n",
        ":4: a section must begin here"},
       {"an element too few", vertices + "*ELEMENTS\nTET\n2 4 0\n1 1 2 3 4\n",
        ":11: unexpected end of file; expected element 2"},
       {"10^12 vertices", "*VERTICES\n1000000000000 3 0 0\n1 0 0 0\n",
        ":2: the number of vertices is 1000000000000"},
       {"2·10^9 vertices", "*VERTICES\n2000000000 3 0 0\n1 0 0 0\n",
        ":4: unexpected end of file; expected vertex 2"},
       {"negative count", "*VERTICES\n-4 3 0 0\n", ":2: the number of vertices is -4"},
       {"two dimensions", "*VERTICES\n4 2 0 0\n", ":2: the width of vertices is wrong; 3 is needed"},
       {"nan", "*VERTICES\n1 3 0 0\n1 0 nan 0\n", ":3: a coordinate is not finite"},
       {"infinite", "*VERTICES\n1 3 0 0\n1 0 0 -inf\n", ":3: a coordinate is not finite"},
       {"no number", "*VERTICES\n1 3 0 0\n1 0 x 0\n", ":3: a coordinate is 'x'"},
       {"coordinate missing", "*VERTICES\n1 3 0 0\n1 0 0\n",
        ":3: unexpected end of line; expected a coordinate"},
       {"coordinate too many", "*VERTICES\n1 3 0 0\n1 0 0 0 0\n", ":3: '0' follows the vertex"},
       {"vertex twice", "*VERTICES\n2 3 0 0\n1 0 0 0\n1 0 0 0\n", ":4: vertex 1 is given twice"},
       {"negative number", "*VERTICES\n2 3 0 0\n-1 0 0 0\n", ":3: vertex has the number -1"},
       {"second vertices", elements + vertices, "a second *VERTICES"},
       {"elements first", "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n" + vertices, ":1: *ELEMENTS before *VERTICES"},
       {"unknown type", vertices + "*ELEMENTS\nWEDGE\n1 6 0\n", ":8: elements of type 'WEDGE'"},
       {"vertex too large", vertices + "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 5\n", ":10: vertex 5 does not exist"},
       {"vertex zero", vertices + "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 0\n", ":10: vertex 0 does not exist"},
       {"vertex negative", vertices + "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 -1\n", ":10: vertex -1 does not exist"},
       {"corner missing", vertices + "*ELEMENTS\nTET\n1 4 0\n1 1 2 3\n",
        ":10: unexpected end of line; expected a vertex"},
       {"corner too many", vertices + "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4 1\n", ":10: '1' follows the element"},
       {"cubic with four", vertices + "*ELEMENTS\nCUBIC\n1 4 0\n",
        ":9: the width of elements is wrong; 8 is needed"},
       {"element twice", vertices + "*ELEMENTS\nTET\n2 4 0\n1 1 2 3 4\n1 1 2 3 4\n",
        ":11: element 1 is given twice"},
       {"set out of range", elements + "*SET a\n1, 2\n", ":12: element 2 does not exist"},
       {"set of words", elements + "*SET a\nb\n", ":12: an element of set 'a' is 'b'"},
       {"set without name", elements + "*SET\n1\n", ":11: a set has no name"},
       {"set before elements", vertices + "*SET a\n1\n", ":7: *SET before *ELEMENTS"},
       {"material without properties", elements + "*MATERIAL m\n",
        ":12: unexpected end of file; expected the properties"},
       {"region without material", elements + "*REGION\nallElements\n", ":12: a region has no comma"},
       {"region of no material", elements + "*REGION\nallElements, m\n", ":12: material 'm' does not exist"},
       {"region of no set", elements + "*MATERIAL m\nENU, 1, 1, 0\n*REGION\na, m\n",
        ":14: set 'a' does not exist"},
       {"include without name", "*INCLUDE\n", ":1: *INCLUDE names no file"},
       {"include missing", "*VERTICES\n*INCLUDE none.txt\n",
        ":2: the included file 'none.txt' does not exist"},
       {"include itself", "*VERTICES\n*INCLUDE a.veg\n", ":2: the included file 'a.veg' includes itself"},
       {"unknown with numbers", elements + "*FIXED\n1 2\n", ":11: the section *FIXED is unknown"}});
}

TEST(Vega, KeepsIdsOfElementsThatCountFromAnotherNumberThanVertices) {
  const TemporaryFolder folder;
  std::string text(kTwoTets);
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1.5",
            "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1.5"},
           {"1 1 2 3 4\n2 5 3 2 4", "1 0 1 2 3\n2 4 2 1 3"}})
    text = with(text, from, to);
  Mesh mesh = read_mesh(folder.file("a.veg", text));
  EXPECT_TRUE(mesh.cell_ids.empty());
  const std::vector<Index> turned{1, 0};
  apply_reordering(mesh, Permutation::identity(5), Permutation::from_old_to_new(turned), Ids::keep);
  EXPECT_EQ(mesh.cell_ids, (std::vector<std::int64_t>{2, 1}));
  write_mesh(mesh, folder.path() / "b.veg");
  EXPECT_NE(content_of(folder.path() / "b.veg").find("2 4 2 1 3\n1 0 1 2 3\n"), std::string::npos);
}

TEST(Vega, ARegionNamesItsSetAsTheSetIsWritten) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.veg", with(with(std::string(kTwoTets), "*SET upper", "*SET up # per"),
                                                  "upper, hard", "up # per, hard")));
  Notes notes;
  write_mesh(mesh, folder.path() / "b.veg", &notes);
  const Mesh back = read_mesh(folder.path() / "b.veg");
  EXPECT_EQ(find_array(back, "label", Association::cells)->values,
            find_array(mesh, "label", Association::cells)->values);
}

TEST(Vega, KeepsUnknownSectionsThatNameNoElements) {
  const TemporaryFolder folder;
  const std::string text =
      "*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n\n*ELEMENTS\nTET\n1 4 0\n1 1 2 3 "
      "4\n\n*DAMPING rayleigh\nmass 0.1\n\n";
  write_mesh(read_mesh(folder.file("a.veg", text)), folder.path() / "b.veg");
  EXPECT_EQ(content_of(folder.path() / "b.veg"), text);
}

TEST(Vega, KeepsAMemberThatASetNamesTwiceOnce) {
  const TemporaryFolder folder;
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("a.veg", with(std::string(kTwoTets), "upper\n2", "upper\n2, 1\n2")),
                              {.notes = &notes});
  EXPECT_EQ(mesh.sets.at(0).members, (std::vector<Index>{1, 0}));
  EXPECT_EQ(notes, Notes{"the set 'upper' names 1 members twice, which are kept once"});
}

TEST(Vega, NoticesTruncation) { expect_truncation_is_noticed("a.veg", kTwoTets); }

TEST(Vega, WritesAndReadsBothTypes) {
  for (const auto& [shape, width] : {std::pair{Shape::tetrahedron, 4}, std::pair{Shape::hexahedron, 8}}) {
    Mesh mesh = cells_of_type(shape, width, 5);
    mesh.data.clear();
    std::erase_if(mesh.sets, [](const EntitySet& set) { return set.association == Association::vertices; });
    expect_write_and_read(mesh, "a.veg");
  }
}

TEST(Vega, NotesWhatItCannotHold) {
  const TemporaryFolder folder;
  Mesh mesh = tetrahedral_bar(1);
  mesh.vertex_ids = {2, 3, 4, 5, 6, 7, 8, 9};
  Notes notes;
  write_mesh(mesh, folder.path() / "a.veg", &notes);
  EXPECT_EQ(notes, (Notes{"the set 'fixed' of vertices is not written: Vega cannot hold it",
                          "the array 'label' on vertices is not written: Vega cannot hold it",
                          "the array 'temperature' on vertices is not written: Vega cannot hold it",
                          "the array 'stress' on vertices is not written: Vega cannot hold it",
                          "labels of cells are written as sets named label_N",
                          "the array 'temperature' on cells is not written: Vega cannot hold it",
                          "the array 'stress' on cells is not written: Vega cannot hold it",
                          "the ids of vertices are not written: Vega numbers them by position"}));
  const Mesh back = read_mesh(folder.path() / "a.veg");
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
  ASSERT_EQ(back.sets.size(), 4U);
  EXPECT_EQ(back.sets[0], (EntitySet{"part", Association::cells, {0, 5}}));
  EXPECT_EQ(back.sets[3], (EntitySet{"label_3", Association::cells, {2, 5}}));
}

TEST(Vega, RefusesOtherCellsAndMixtures) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.veg";
  EXPECT_NE(write_error(mixed_mesh(), path).find("Vega cannot hold a cell of type pyramid"),
            std::string::npos);
  EXPECT_NE(write_error(cells_of_type(Shape::tetrahedron, 10, 1), path).find("of type tetrahedron10"),
            std::string::npos);
  Mesh mesh = cells_of_type(Shape::hexahedron, 8, 1);
  mesh.cells.push_back(Shape::tetrahedron, std::vector<Index>{0, 1, 2, 3});
  mesh.data.clear();
  EXPECT_NE(write_error(mesh, path).find("both tetrahedra and hexahedra"), std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

TEST(Vega, OrdersARealMeshAndBack) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "arch.veg";
  write_mesh(read_mesh(data_mesh("arch.msh")), path);
  EXPECT_EQ(read_mesh(path).cell_count(), 96);
  expect_order_and_back(path);
}

TEST(Vega, AMeshWithoutItsIncludesStopsAndWithThemOrdersAndBack) {
  const TemporaryFolder folder;
  const Mesh ring = read_mesh(data_mesh("ring.ele"));
  std::string text = "# Vega mesh file\n\n*VERTICES\n128 3 0 0\n";
  for (Index v = 0; v < ring.vertex_count(); ++v) {
    const Point& point = ring.points[v];
    text += fmt::format("{} {} {} {}\n", v + 1, point[0], point[1], point[2]);
  }
  text += "\n*ELEMENTS\nTET\n295 4 0\n";
  Index count = 0;
  for (Index c = 0; c < ring.cell_count(); ++c) {
    const auto cell = ring.cells[c];
    if (ring.cells.shapes[c] != Shape::tetrahedron) continue;
    text += fmt::format("{} {} {} {} {}\n", ++count, cell[0] + 1, cell[1] + 1, cell[2] + 1, cell[3] + 1);
  }
  const auto line = std::count(text.begin(), text.end(), '\n') + 3;
  text +=
      "\n*SET shell\n*INCLUDE shellList.txt\n\n# all other elements\n*SET rest\n*INCLUDE restList.txt\n\n"
      "*MATERIAL hard\nENU, 1000, 25000000, 0.45\n\n*MATERIAL soft\nENU, 1000, 250000, 0.35\n\n"
      "*REGION\nshell, hard\n\n*REGION\nrest, soft\n";
  const auto path = folder.file("ring.veg", text);
  EXPECT_NE(
      read_error(path).find(fmt::format(".veg:{}: the included file 'shellList.txt' does not exist", line)),
      std::string::npos);

  std::ostringstream shell;
  std::ostringstream rest;
  for (int e = 1; e <= 295; ++e) (e % 4 == 0 ? shell : rest) << e << (e % 7 == 0 ? ",\n" : ", ");
  (void)folder.file("shellList.txt", shell.str());
  (void)folder.file("restList.txt", rest.str());
  const Mesh mesh = read_mesh(path);
  ASSERT_EQ(mesh.sets.size(), 2U);
  EXPECT_EQ(mesh.sets[0].members.size(), 73U);
  EXPECT_EQ(mesh.sets[1].members.size(), 222U);
  const auto& labels =
      std::get<std::vector<std::int32_t>>(find_array(mesh, kLabel, Association::cells)->values);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 1), 73);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 2), 222);
  expect_order_and_back(path);
}

}  // namespace
}  // namespace meshorder
