// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/ucd/ucd.hpp"

#include "io/format.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// a cell of each type, numbers with gaps, data with units in another order than the nodes, and model data
constexpr std::string_view kUcd =
    "# made by hand\n"
    "# 9 nodes\n"
    "\n"
    "9 8 3 1 2\n"
    "10 0 0 1\n"
    "11 1 0 1\n"
    "12 1 1 1\n"
    "13 0 1 1\n"
    "20 0 0 0\n"
    "21 1 0 0\n"
    "22 1 1 0\n"
    "23 0 1 0\n"
    "30 0.5 0.5 2\n"
    "1 7 hex 10 11 12 13 20 21 22 23\n"
    "2 7 pyr 30 10 11 12 13\n"
    "3 -1 prism 10 11 12 20 21 22\n"
    "4 0 tet 20 21 22 30\n"
    "5 3 quad 20 21 22 23\n"
    "6 3 tri 20 21 22\n"
    "7 4 line 20 21\n"
    "18 5 pt 30\n"
    "2 1 2\n"
    "temperature, K\n"
    "flow of heat, W/m^2\n"
    "30 9 1 2\n"
    "10 1 0 0\n"
    "11 2 0 0.5\n"
    "12 3 0 0\n"
    "13 4 0 0\n"
    "20 5 0 0\n"
    "21 6 0 -1e-300\n"
    "22 7 0 0\n"
    "23 8 0 0\n"
    "1 1\n"
    "stress\n"
    "18 80\n"
    "1 10\n"
    "2 20\n"
    "3 30\n"
    "4 40\n"
    "5 50\n"
    "6 60\n"
    "7 70\n"
    "1 2\n"
    "of the model, none\n"
    "1 2\n";

Mesh read_ucd(std::string_view content, Notes* notes = nullptr, const std::string& name = "m.avs") {
  const TemporaryFolder folder;
  return read_mesh(folder.file(name, content), {.notes = notes});
}

std::string ucd_text(const Mesh& mesh, Notes* notes = nullptr, const std::string& name = "m.avs") {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / name, notes);
  return test::content_of(folder.path() / name);
}

const std::vector<double>& ucd_values(const Mesh& mesh, std::string_view name, Association association) {
  return std::get<std::vector<double>>(find_array(mesh, name, association)->values);
}

TEST(Ucd, ReadsCellsMaterialsAndData) {
  Notes notes;
  const Mesh mesh = read_ucd(kUcd, &notes);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_EQ(mesh.format, "ucd");
  EXPECT_THAT(mesh.cells.shapes,
              ElementsAre(Shape::hexahedron, Shape::pyramid, Shape::wedge, Shape::tetrahedron, Shape::quad,
                          Shape::triangle, Shape::line, Shape::vertex));
  // as meshio has them: the bottom of the hexahedron and the wedge first, the apex of the pyramid last
  EXPECT_THAT(mesh.cells[0], ElementsAre(4, 5, 6, 7, 0, 1, 2, 3));
  EXPECT_THAT(mesh.cells[1], ElementsAre(0, 1, 2, 3, 8));
  EXPECT_THAT(mesh.cells[2], ElementsAre(4, 5, 6, 0, 1, 2));
  EXPECT_THAT(mesh.cells[3], ElementsAre(4, 5, 8, 6));
  EXPECT_THAT(mesh.vertex_ids, ElementsAre(10, 11, 12, 13, 20, 21, 22, 23, 30));
  EXPECT_THAT(mesh.cell_ids, ElementsAre(1, 2, 3, 4, 5, 6, 7, 18));
  EXPECT_THAT(std::get<std::vector<std::int32_t>>(find_array(mesh, kLabel, Association::cells)->values),
              ElementsAre(7, 7, -1, 0, 3, 3, 4, 5));
  EXPECT_THAT(ucd_values(mesh, "temperature", Association::vertices), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_EQ(find_array(mesh, "flow of heat", Association::vertices)->components, 2);
  EXPECT_EQ(ucd_values(mesh, "flow of heat", Association::vertices)[17], 2);
  EXPECT_THAT(ucd_values(mesh, "stress", Association::cells), ElementsAre(10, 20, 30, 40, 50, 60, 70, 80));
  EXPECT_THAT(mesh.format_metadata->contents(),
              ElementsAre("the unit 'W/m^2' of 'flow of heat'", "the unit 'K' of 'temperature'",
                          "data of the model"));
}

TEST(Ucd, WritesAFileAsItWas) {
  Notes notes;
  const std::string text = ucd_text(read_ucd(kUcd), &notes);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_THAT(text, testing::StartsWith("# made by hand\n# 9 nodes\n9 8 3 1 2\n10 0 0 1\n"));
  EXPECT_THAT(
      text, HasSubstr(std::string(kUcd.substr(kUcd.find("1 7 hex"), kUcd.find("30 9") - kUcd.find("1 7")))));
  EXPECT_THAT(text, HasSubstr("\n1 1\nstress\n1 10\n"));
  EXPECT_THAT(text, testing::EndsWith("18 80\n1 2\nof the model, none\n1 2\n"));
  test::expect_same(read_ucd(text), read_ucd(kUcd));
  EXPECT_EQ(ucd_text(read_ucd(text)), text);
}

TEST(Ucd, FollowsANewOrder) {
  Mesh mesh = read_ucd(kUcd);
  std::vector<Index> turned(9);
  std::iota(turned.begin(), turned.end(), Index{1});
  turned.back() = 0;
  apply_reordering(mesh, Permutation::from_old_to_new(std::move(turned)), Permutation::identity(8));
  const std::string text = ucd_text(mesh);
  EXPECT_THAT(text, HasSubstr("9 8 3 1 2\n10 0.5 0.5 2\n11 0 0 1\n")) << "numbers ascend along the new order";
  EXPECT_THAT(text, HasSubstr("2 7 pyr 10 11 12 13 20\n"));
  EXPECT_THAT(text, HasSubstr("\n10 9 1 2\n11 1 0 0\n12 2 0 0.5\n"));
}

TEST(Ucd, HoldsAllThatOtherMeshesHave) {
  for (const auto& [shape, vertices] : test::linear_types()) {
    if (!format_named("ucd").holds({}, shape, vertices)) continue;
    Mesh mesh = test::cells_of_type(shape, vertices, 3);
    mesh.sets.clear();
    mesh.format = "ucd";  // no notes on another format
    const Mesh back = read_ucd(ucd_text(mesh));
    EXPECT_EQ(back.cells, mesh.cells) << to_string(shape);
    EXPECT_EQ(back.points, mesh.points);
    for (const DataArray& array : mesh.data) {
      EXPECT_NE(find_array(back, array.name, array.association), nullptr) << array.name;
    }
    EXPECT_EQ(ucd_values(back, "stress", Association::cells), ucd_values(mesh, "stress", Association::cells));
  }
}

TEST(Ucd, NamesWhatItCannotHold) {
  Mesh mesh = test::tetrahedral_bar(1);
  mesh.data.push_back(
      {"a, b", Association::vertices, 1, std::vector<float>(mesh.points.size(), 0.1F), {}, {}});
  mesh.data.push_back({"large",
                       Association::cells,
                       1,
                       std::vector<std::int64_t>(mesh.cells.shapes.size(), (std::int64_t{1} << 53) + 1),
                       {},
                       {}});
  mesh.data.push_back({"some", Association::cells, 1, std::vector<double>{1}, {2}, {}});
  Notes notes;
  const Mesh back = read_ucd(ucd_text(mesh, &notes));
  EXPECT_THAT(notes, testing::IsSupersetOf({HasSubstr("the array 'a, b' on vertices is written as 'a_ b'"),
                                            HasSubstr("the array 'large' loses digits"),
                                            HasSubstr("the array 'some' on cells is not written"),
                                            HasSubstr("the set 'fixed' of vertices is not written")}));
  EXPECT_EQ(ucd_values(back, "a_ b", Association::vertices).front(), double{0.1F});
}

TEST(Ucd, SharesItsExtensionWithAbaqus) {
  EXPECT_EQ(read_ucd(kUcd, nullptr, "m.inp").format, "ucd");
  EXPECT_EQ(read_ucd("\xEF\xBB\xBF" + std::string(kUcd), nullptr, "m.inp").format, "ucd");
  EXPECT_EQ(format_of_bytes(kUcd)->name, "UCD");
  const std::string deck = ucd_text(test::tetrahedral_bar(1), nullptr, "m.inp");
  EXPECT_THAT(deck, HasSubstr("*NODE")) << "other meshes are decks";
  EXPECT_EQ(read_ucd(deck, nullptr, "m.inp").format, "abaqus");
  EXPECT_EQ(ucd_text(read_ucd(kUcd), nullptr, "m.inp"), ucd_text(read_ucd(kUcd)));
  EXPECT_FALSE(ucd::begins_ucd("8 3 0 0\n1 0 0 0\n")) << "a .node file of TetGen";
  EXPECT_FALSE(ucd::begins_ucd("1 2 3 4 5\n6 7 8 9 10\n"));
  EXPECT_FALSE(ucd::begins_ucd(""));
}

TEST(Ucd, NumbersCellsByPlacesWhereTheirNumbersAreNone) {
  Notes notes;
  const Mesh mesh = read_ucd(with(std::string(kUcd), "2 7 pyr", "1 7 pyr"), &notes);
  EXPECT_THAT(notes,
              ElementsAre(HasSubstr(":15: cell 1 is given twice; all cells are now numbered by position")));
  EXPECT_THAT(mesh.cell_ids, IsEmpty());
  EXPECT_THAT(ucd_values(mesh, "stress", Association::cells), ElementsAre(80, 10, 20, 30, 40, 50, 60, 70));
}

TEST(Ucd, ComesBackFromAnyOrder) {
  const std::string text = ucd_text(read_ucd(kUcd));
  test::expect_order_and_back_to("m.avs", text);
}

TEST(Ucd, NoticesATruncatedMesh) {
  for (std::size_t length = 0; length < kUcd.size(); length += 3) {
    try {
      (void)read_ucd(kUcd.substr(0, length));
    } catch (const Error&) {  // one clear error; no crash
    }
  }
}

TEST(Ucd, RefusesBrokenFiles) {
  const auto changed = [](std::string_view old, std::string_view by) {
    return with(std::string(kUcd), old, by);
  };
  test::expect_broken(
      "m.avs",
      {{"binary", "\7 binary", "is a binary AVS UCD file; save it as text"},
       {"counts", changed("9 8 3 1 2", "9 8 3 1"), ":4: the first line has fewer than five counts"},
       {"many counts", changed("9 8 3 1 2", "9 8 3 1 2 0"), ":4: the line of counts is too long"},
       {"negative", changed("9 8 3 1 2", "9 8 -3 1 2"), ":4: the number of values of nodes is -3"},
       {"too many nodes", changed("9 8 3 1 2", "900000000 8 3 1 2"), ":4: "},
       {"node twice", changed("11 1 0 1", "10 1 0 1"), ":6: node 10 is given twice"},
       {"infinite", changed("11 1 0 1", "11 inf 0 1"), ":6: "},
       {"type", changed("hex", "brick"), ":14: a cell has the type 'brick'; known: pt, line"},
       {"no node", changed("18 5 pt 30", "18 5 pt 31"), ":21: a node of cell 18 is 31, which"},
       {"quadratic", changed("7 4 line 20 21", "7 4 line 20 21 22"),
        ":20: the line of cell 7 is too long; a cell of type line has 2 nodes"},
       {"sizes", changed("2 1 2\n", "2 1 3\n"), ":22: the components of the arrays do not add up to 3"},
       {"sizes of 0", changed("2 1 2\n", "3 1 2 0\n"), ":22: the components"},
       {"no such node", changed("30 9 1 2", "31 9 1 2"), ":25: node 31 does not exist"},
       {"data twice", changed("10 1 0 0", "30 1 0 0"), ":26: the node has data twice"},
       {"too few values", changed("10 1 0 0\n", "10 1 0\n"), "is too long"},
       {"data beyond counts", changed("9 8 3 1 2", "9 8 3 1 0"), ":44: the file continues after its last"}});
}

}  // namespace
}  // namespace meshorder
