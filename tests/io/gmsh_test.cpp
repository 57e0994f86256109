// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "io/gmsh_files.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace meshorder::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Ints = std::vector<std::int32_t>;
using Reals = std::vector<double>;

Mesh read_text(std::string_view content, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  return read_mesh(folder.file("mesh.msh", content), {.notes = notes});
}

std::string written(const Mesh& mesh, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "mesh.msh", notes);
  return content_of(folder.path() / "mesh.msh");
}

/// The array's values, which must be of type T.
template <class T>
std::vector<T> values(const Mesh& mesh, std::string_view name, Association association) {
  const DataArray* array = find_array(mesh, name, association);
  if (!array || !std::holds_alternative<std::vector<T>>(array->values)) {
    ADD_FAILURE() << "no such array: " << name;
    return {};
  }
  return std::get<std::vector<T>>(array->values);
}

const EntitySet& set_of(const Mesh& mesh, std::string_view name) {
  static const EntitySet none{};
  for (const EntitySet& set : mesh.sets) {
    if (set.name == name) return set;
  }
  ADD_FAILURE() << "no such set: " << name;
  return none;
}

/// The text between $name and $Endname.
std::string section(const std::string& content, const std::string& name) {
  const auto begin = content.find("$" + name + "\n");
  const auto end = content.find("$End" + name + "\n");
  if (begin == std::string::npos || end == std::string::npos) return "";
  return content.substr(begin + name.size() + 2, end - begin - name.size() - 2);
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const auto at = text.find(what);
  if (at == std::string::npos) ADD_FAILURE() << "not there: " << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

// ---- reading

TEST(Gmsh, ReadsAllOfVersion41) {
  const Mesh mesh = read_text(kGmsh41);
  ASSERT_EQ(mesh.vertex_count(), 6);
  EXPECT_EQ(mesh.points[2], (Point{0, 1, 0}));
  EXPECT_EQ(mesh.vertex_ids, (std::vector<std::int64_t>{2, 10, 20, 30, 35, 40}));
  EXPECT_EQ(mesh.cell_ids, (std::vector<std::int64_t>{3, 7, 9}));
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::triangle, Shape::tetrahedron, Shape::tetrahedron}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 0, 1, 2, 3, 0, 2, 1, 5}));
  EXPECT_EQ(mesh.cell_blocks, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(values<std::int32_t>(mesh, kLabel, Association::cells), (Ints{7, 4, 9}));
  EXPECT_EQ(values<std::int32_t>(mesh, "gmsh:geometrical", Association::cells), (Ints{3, 5, 6}));
  EXPECT_EQ(values<std::int32_t>(mesh, "gmsh:dim_tags", Association::vertices),
            (Ints{0, 1, 2, 3, 2, 3, 3, 5, 3, 5, 3, 5}));
  EXPECT_EQ(values<double>(mesh, "gmsh:parametric", Association::vertices),
            (Reals{0, 0, 0, 0, 1, 0.5, 0.25, 0, 1, 0.75, 0.125, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Gmsh, GivesNamedGroupsAndPeriodicNodesAsSets) {
  const Mesh mesh = read_text(kGmsh41);
  EXPECT_THAT(set_of(mesh, "inlet").members, ElementsAre(0));
  EXPECT_THAT(set_of(mesh, "rock").members, ElementsAre(1));
  EXPECT_THAT(set_of(mesh, "all of it").members, ElementsAre(1, 2));
  EXPECT_THAT(set_of(mesh, "gmsh:periodic 2 3").members, ElementsAre(1, 2));
  EXPECT_THAT(set_of(mesh, "gmsh:periodic 2 3 master").members, ElementsAre(0, 3));
}

TEST(Gmsh, KeepsStepsOfDataApartAndKnowsPartialData) {
  const Mesh mesh = read_text(kGmsh41);
  EXPECT_EQ(values<double>(mesh, "heat step 0", Association::vertices),
            (Reals{1.5, 2.5, 3.5, 4.5, 5.5, 6.5}));
  const DataArray* second = find_array(mesh, "heat step 1", Association::vertices);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->components, 3);
  EXPECT_EQ(second->indices, (std::vector<Index>{5, 1}));
  EXPECT_EQ(find_array(mesh, "stress", Association::cells)->indices, (std::vector<Index>{2}));
  // one value for each node of a cell, filled up with 0
  EXPECT_EQ(values<double>(mesh, "jump", Association::cells), (Reals{1, 2, 3, 0, 4, 5, 6, 7}));
  EXPECT_THAT(mesh.format_metadata->contents(), Contains("the times and steps of data"));
  EXPECT_THAT(mesh.format_metadata->contents(), Contains("Gmsh's $Entities"));
}

TEST(Gmsh, KeepsViewsWithoutANameApart) {
  const auto view = [](const char* values) {
    return std::string("$NodeData\n1\n\"\"\n1\n0\n3\n0\n1\n") + values + "$EndNodeData\n";
  };
  const std::string text =
      std::string(kGmsh41) + view("2\n2 0.5\n10 0.25\n") + view("1\n2 8\n") + view("0\n");
  const Mesh mesh = read_text(text);
  EXPECT_EQ(values<double>(mesh, " step 0", Association::vertices), (Reals{0.5, 0.25}));
  const MemoryFiles files = write_mesh_to_memory(mesh, "gmsh", "m.msh");
  expect_same(read_text(files.files.front().bytes), mesh);
  EXPECT_THAT(files.files.front().bytes,
              EndsWith(view("2\n2 0.5\n10 0.25\n") + view("1\n2 8\n") + view("0\n")));
}

TEST(Gmsh, ReadsAllOfVersion22) {
  const Mesh mesh = read_text(kGmsh22);
  EXPECT_THAT(mesh.vertex_ids, IsEmpty());
  EXPECT_THAT(mesh.cell_ids, IsEmpty());
  EXPECT_THAT(mesh.cell_blocks, IsEmpty());
  EXPECT_EQ(mesh.cells.shapes,
            (std::vector{Shape::vertex, Shape::tetrahedron, Shape::triangle, Shape::tetrahedron}));
  EXPECT_EQ(values<std::int32_t>(mesh, kLabel, Association::cells), (Ints{0, 4, 7, 9}));
  EXPECT_EQ(values<std::int32_t>(mesh, "gmsh:geometrical", Association::cells), (Ints{1, 5, 3, 6}));
  EXPECT_EQ(values<std::int32_t>(mesh, "gmsh:partitions", Association::cells),
            (Ints{0, 0, 0, 1, 2, 0, 0, 0, 0, 2, 1, -2}));
  EXPECT_EQ(values<double>(mesh, "stress", Association::cells), (Reals{0.5, 1.5, 2.5, 3.5}));
  EXPECT_THAT(set_of(mesh, "rock").members, ElementsAre(1));
}

TEST(Gmsh, ReadsBinaryFilesOfBothByteOrdersAlike) {
  expect_same(read_text(gmsh_41_binary(std::endian::big)), read_text(gmsh_41_binary(std::endian::little)));
  expect_same(read_text(gmsh_22_binary(std::endian::big)), read_text(gmsh_22_binary(std::endian::little)));
  EXPECT_EQ(read_text(gmsh_41_binary(std::endian::big)).points, read_text(kGmsh41).points);
  EXPECT_EQ(read_text(gmsh_22_binary(std::endian::big)).points, read_text(kGmsh22).points);
  EXPECT_EQ(read_text(gmsh_41_binary(std::endian::big)).cells, read_text(kGmsh41).cells);
  EXPECT_EQ(values<double>(read_text(gmsh_22_binary(std::endian::big)), "heat", Association::vertices),
            (Reals{0.1}));
}

TEST(Gmsh, ReadsVersion40As41) {
  expect_same(read_text(gmsh_40()), read_text(kGmsh41));
  expect_same(read_text(gmsh_40_binary(std::endian::big)), read_text(gmsh_40_binary(std::endian::little)));
  const Mesh binary = read_text(gmsh_40_binary(std::endian::little));
  const Mesh text = read_text(kGmsh41);
  EXPECT_EQ(binary.points, text.points);
  EXPECT_EQ(binary.cells, text.cells);
  EXPECT_EQ(binary.vertex_ids, text.vertex_ids);
  EXPECT_EQ(binary.cell_ids, text.cell_ids);
  EXPECT_EQ(values<std::int32_t>(binary, "gmsh:dim_tags", Association::vertices),
            values<std::int32_t>(text, "gmsh:dim_tags", Association::vertices));
  EXPECT_EQ(values<std::int32_t>(binary, kLabel, Association::cells), (Ints{7, 4, 9}));
  EXPECT_EQ(values<double>(binary, "gmsh:parametric", Association::vertices),
            (Reals{0, 0, 0, 0, 1, 0.5, 0.25, 0, 1, 0.75, 0.125, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(values<std::int32_t>(binary, "gmsh:ghosts", Association::cells), (Ints{1, 2, 3, 4}));
  EXPECT_EQ(set_of(binary, "gmsh:periodic 2 3").members, set_of(text, "gmsh:periodic 2 3").members);
  EXPECT_THAT(set_of(binary, "gmsh:periodic 0 1").members, ElementsAre(0));
}

TEST(Gmsh, ReadsAllOfVersion1) {
  const Mesh mesh = read_text(kGmsh1);
  const Mesh newer = read_text(kGmsh22);
  EXPECT_EQ(mesh.points, newer.points);
  EXPECT_EQ(mesh.cells, newer.cells);
  EXPECT_EQ(values<std::int32_t>(mesh, kLabel, Association::cells), (Ints{0, 4, 7, 9}));
  EXPECT_EQ(values<std::int32_t>(mesh, "gmsh:geometrical", Association::cells), (Ints{1, 5, 3, 6}));
  // other names that Gmsh reads
  std::string names(kGmsh1);
  for (const auto& [old, fresh] :
       {std::pair{"$NOD", "$NOE"}, {"$ENDNOD", "$EndNOE"}, {"$ENDELM", "$EndELM"}}) {
    names = replaced(names, old, fresh);
  }
  expect_same(read_text(names), mesh);
  const Mesh with_comments = read_text(std::string(kGmsh1) + "$Comments\nhe said $End\n$ENDComments\n");
  EXPECT_THAT(written(with_comments), EndsWith("$ENDELM\n$Comments\nhe said $End\n$ENDComments\n"));
  // GetFEM writes it in the singular
  const std::string singular = "$Comment\nversion 2.1 of 1999\n$ENDComment\n";
  EXPECT_THAT(written(read_text(std::string(kGmsh1) + singular)), HasSubstr(singular));
}

TEST(Gmsh, ReadsManyElementsAsOneAfterAnother) {
  // the reader takes elements of version 1 one after another. Both files have long runs of one type, types in
  // turn, and broken lines
  constexpr int kNodes = 50;
  constexpr int kElements = 9000;
  std::string nodes = fmt::format("{}\n", kNodes);
  for (int v = 1; v <= kNodes; ++v) nodes += fmt::format("{} {} 0.5 {}\n", 3 * v, v, -v);
  std::string old_elements = fmt::format("{}\n", kElements);
  std::string elements = old_elements;
  for (int e = 1; e <= kElements; ++e) {
    const bool is_triangle = e < 1500 || (e > 4000 && e < 4100 && e % 2 == 0) || e > 8500;
    std::string corners;
    for (int k = 0; k < (is_triangle ? 3 : 4); ++k)
      corners += fmt::format("{}{}", e % 1000 == 7 ? "\n" : " ", 3 * ((e + 11 * k) % kNodes + 1));
    const int type = is_triangle ? 2 : 4;
    old_elements += fmt::format("{} {} {} {} {}{}\n", e, type, e % 5, e % 3, is_triangle ? 3 : 4, corners);
    elements += fmt::format("{} {} 2 {}{} {}{}\n", e, type, e % 700 == 9 ? "+" : "", e % 5, e % 3, corners);
  }
  const Mesh expected = read_text("$NOD\n" + nodes + "$ENDNOD\n$ELM\n" + old_elements + "$ENDELM\n");
  const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n";
  const Mesh found = read_text(head + elements + "$EndElements\n");
  EXPECT_EQ(found.points, expected.points);
  EXPECT_EQ(found.vertex_ids, expected.vertex_ids);
  EXPECT_EQ(found.cells, expected.cells);
  EXPECT_EQ(values<std::int32_t>(found, "label", Association::cells),
            values<std::int32_t>(expected, "label", Association::cells));
  const TemporaryFolder folder;
  const std::string broken = head + with(elements, "\n8999 2 2", "\n8999 2 -2");
  EXPECT_THAT(read_error(folder.file("mesh.msh", broken)), HasSubstr(":9091: the number of tags is -2"));
}

TEST(Gmsh, EndsANameAtItsSecondQuoteAndKeepsTheRest) {
  const std::string content =
      replaced(std::string(kGmsh41), "\"rock\"", "\"rock\" lower_dimensional_block \"x\"");
  const Mesh mesh = read_text(content);
  EXPECT_THAT(set_of(mesh, "rock").members, ElementsAre(1));
  EXPECT_EQ(written(mesh), content);
}

TEST(Gmsh, TakesAnyEndOfASectionForItsEndAndSaysSo) {
  for (const auto& [file, end, found] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {std::string(kGmsh22), "$EndElementData", "$EndElememtData"},
           {std::string(kGmsh41), "$EndNodes", "$EndNode"},
           {std::string(kGmsh41), "$EndPhysicalNames", "$EndPhysicalName"},
           {std::string(kGmsh1), "$ENDELM", "$ENDELEM"}}) {
    Notes notes;
    const Mesh mesh = read_text(replaced(file, end + "\n", found + "\n"), &notes);
    EXPECT_EQ(written(mesh), file);
    EXPECT_THAT(notes, ElementsAre(HasSubstr(": " + found + " is read as " + end)));
  }
}

TEST(Gmsh, UnderstandsAnyLineEnds) {
  std::string content;
  int line = 0;
  for (const char c : kGmsh41) {
    if (c != '\n') {
      content += c;
    } else {
      content += std::array{"\n", "\r\n", "\r"}[line++ % 3];
    }
  }
  expect_same(read_text(content), read_text(kGmsh41));
}

TEST(Gmsh, TakesFilesWithoutEntitiesAndGroups) {
  const Mesh mesh = read_text(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 0 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 "
      "0\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 0 2 1\n1 1 2 3\n$EndElements\n");
  EXPECT_EQ(mesh.cell_count(), 1);
  EXPECT_FALSE(find_array(mesh, kLabel, Association::cells));
}

// ---- writing what was read

TEST(Gmsh, TakesBlocksOfOneKindThatFollowEachOtherForOne) {
  const std::string head =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 5 1 5\n2 0 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n"
      "1 1 0\n2 0 0\n$EndNodes\n$Elements\n";
  const std::string elements = "2 1 2 1\n1 1 2 3\n2 1 2 1\n2 2 4 3\n2 2 2 1\n3 2 5 4\n";
  const Mesh mesh = read_text(head + "3 3 1 3\n" + elements + "$EndElements\n");
  EXPECT_THAT(mesh.cell_blocks, ElementsAre(0, 2));
  EXPECT_EQ(read_text(written(mesh)).cell_blocks, mesh.cell_blocks);
  // blocks that do not follow each other are dropped: the order of cells matters more
  const std::string turns = "2 1 2 1\n1 1 2 3\n2 2 2 1\n2 2 4 3\n2 1 2 1\n3 2 5 4\n";
  const Mesh in_turns = read_text(head + "3 3 1 3\n" + turns + "$EndElements\n");
  EXPECT_THAT(in_turns.cell_blocks, IsEmpty());
  EXPECT_THAT(read_text(written(in_turns)).cell_blocks, IsEmpty());
}

TEST(Gmsh, WritesAgainWhatItReadByteForByte) {
  for (const std::string& content :
       {std::string(kGmsh41), gmsh_40(), std::string(kGmsh22), std::string(kGmsh1),
        gmsh_40_binary(std::endian::little), gmsh_40_binary(std::endian::big),
        gmsh_41_binary(std::endian::little), gmsh_41_binary(std::endian::big),
        gmsh_22_binary(std::endian::little), gmsh_22_binary(std::endian::big)}) {
    Notes notes;
    const std::string again = written(read_text(content), &notes);
    EXPECT_TRUE(again == content) << content.substr(0, 20) << "\n" << again;
    EXPECT_THAT(notes, IsEmpty());
  }
}

TEST(Gmsh, OrdersEveryKindOfFileAndBack) {
  const TemporaryFolder folder;
  for (const std::string& content :
       {std::string(kGmsh41), std::string(kGmsh22), std::string(kGmsh1), gmsh_40(),
        gmsh_40_binary(std::endian::big), gmsh_41_binary(std::endian::little),
        gmsh_41_binary(std::endian::big), gmsh_22_binary(std::endian::little)}) {
    expect_order_and_back(folder.file("mesh.msh", content));
  }
}

TEST(Gmsh, OrdersRealFilesAndBack) {
  for (const char* name : {"arch.msh", "ball.msh", "blocks.msh"}) {
    SCOPED_TRACE(name);
    expect_order_and_back(data_mesh(name));
  }
}

TEST(Gmsh, SplitsNodeBlocksSoThatFileAndNumbersFollowTheOrder) {
  Mesh mesh = read_text(kGmsh41);
  const Permutation vertices = Permutation::from_new_to_old({1, 0, 2, 5, 4, 3});
  apply_reordering(mesh, vertices, Permutation::identity(3));
  EXPECT_EQ(section(written(mesh), "Nodes"),
            "4 6 2 40\n"
            "2 3 1 1\n2\n1 0 0 0.5 0.25\n"
            "0 1 0 1\n10\n0 0 0\n"
            "2 3 1 1\n20\n0 1 0 0.75 0.125\n"
            "3 5 0 3\n30\n35\n40\n0 0 -1\n0.5 0.5 0.5\n0 0 1\n");
  EXPECT_EQ(section(written(mesh), "Periodic"),
            "1\n2 3 8\n16 1 0 0 0 0 1 0 0 0 0 1 0.5 0 0 0 1\n2\n2 10\n20 40\n");
  apply_reordering(mesh, vertices.inverse(), Permutation::identity(3));
  EXPECT_EQ(written(mesh), kGmsh41);
}

TEST(Gmsh, DataFollowTheirCells) {
  Mesh mesh = read_text(kGmsh22);
  apply_reordering(mesh, Permutation::identity(5), Permutation::from_new_to_old({0, 3, 2, 1}));
  const std::string content = written(mesh);
  EXPECT_EQ(section(content, "Elements"),
            "4\n1 15 2 0 1 1\n2 4 5 9 6 2 1 -2 1 3 2 5\n3 2 2 7 3 1 2 3\n4 4 4 4 5 1 2 1 2 3 4\n");
  EXPECT_THAT(section(content, "ElementData"), HasSubstr("1 0.5\n2 3.5\n3 2.5\n4 1.5\n"));
}

TEST(Gmsh, KeepsParametricNodesOfVersion2) {
  const std::string content =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n3\n1 0 0 0 0 1\n2 1 0 0 1 4 0.5\n"
      "3 0 1 0 2 6 0.25 0.75\n$EndParametricNodes\n$Elements\n1\n1 2 2 0 6 1 2 3\n$EndElements\n";
  Mesh mesh = read_text(content);
  EXPECT_EQ(written(mesh), content);
  apply_reordering(mesh, Permutation::from_new_to_old({2, 1, 0}), Permutation::identity(1));
  EXPECT_EQ(section(written(mesh), "ParametricNodes"),
            "3\n1 0 1 0 2 6 0.25 0.75\n2 1 0 0 1 4 0.5\n3 0 0 0 0 1\n");
}

TEST(Gmsh, WritesLabelsThatWereChangedAsData) {
  Mesh mesh = read_text(kGmsh41);
  for (DataArray& array : mesh.data) {
    if (array.name == kLabel) array.values = Ints{1, 2, 3};
  }
  EXPECT_THAT(written(mesh), HasSubstr("\"label\"\n1\n0\n3\n0\n1\n3\n3 1\n7 2\n9 3\n"));
}

TEST(Gmsh, WritesItsOwnArraysAsDataIfTheyGotMoreComponents) {
  for (const std::string_view text : {kGmsh22, kGmsh41}) {
    Mesh mesh = read_text(text);
    for (DataArray& array : mesh.data) {
      if (array.name != "gmsh:geometrical") continue;
      array.components = 3;
      array.values = Ints(3 * mesh.cells.shapes.size(), 4);
    }
    EXPECT_THAT(written(mesh), HasSubstr("\"gmsh:geometrical\""));
  }
}

TEST(Gmsh, NotesSetsAddedToAGmshFile) {
  Mesh mesh = read_text(kGmsh41);
  mesh.sets.push_back({"mine", Association::cells, {0}});
  Notes notes;
  written(mesh, &notes);
  EXPECT_THAT(notes, ElementsAre("the set 'mine' of cells is not written: Gmsh cannot hold it"));
}

TEST(Gmsh, LeavesOutPeriodicPairsOfNodesThatAreNotThere) {
  Notes notes;
  const Mesh mesh = read_text(replaced(std::string(kGmsh41), "20 30\n$EndP", "20 31\n$EndP"), &notes);
  EXPECT_THAT(set_of(mesh, "gmsh:periodic 2 3").members, ElementsAre(1));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("1 pairs of $Periodic are ignored")));
}

TEST(Gmsh, KeepsPeriodicPairsWithANodeOfAnEarlierPair) {
  for (const std::string pairs : {"2\n10 20\n10 30\n", "2\n10 20\n30 20\n", "2\n10 20\n10 20\n"}) {
    Notes notes;
    const Mesh mesh =
        read_text(replaced(std::string(kGmsh41), "2\n10 2\n20 30\n$EndP", pairs + "$EndP"), &notes);
    EXPECT_EQ(set_of(mesh, "gmsh:periodic 2 3").members.size(), 1U);
    EXPECT_EQ(set_of(mesh, "gmsh:periodic 2 3 2 master").members.size(), 1U);
    EXPECT_THAT(notes, IsEmpty());
    EXPECT_THAT(written(mesh), HasSubstr(pairs + "$EndP"));
  }
  std::string many;
  for (int i = 0; i < 66; ++i) many += "10 20\n";
  Notes notes;
  (void)read_text(replaced(std::string(kGmsh41), "2\n10 2\n20 30\n$EndP", "66\n" + many + "$EndP"), &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("2 pairs of $Periodic are ignored: 64 earlier pairs")));
}

TEST(Gmsh, KeepsUnknownSectionsWithoutNumbers) {
  std::string content(kGmsh22);
  content += "$Author\nJane Doe, version2\n$EndAuthor\n";
  EXPECT_EQ(written(read_text(content)), content);
}

// ---- element types

/// The nodes of second-order elements by the corners that they lie between, in the order of Gmsh's manual
/// ("Node ordering") and of VTK's classes.
struct SecondOrder {
  int type;
  Shape shape;
  std::vector<std::vector<int>> gmsh;
  std::vector<std::vector<int>> vtk;
};

std::vector<SecondOrder> second_order() {
  const std::vector<std::vector<int>> hex_gmsh{{0, 1},
                                               {0, 3},
                                               {0, 4},
                                               {1, 2},
                                               {1, 5},
                                               {2, 3},
                                               {2, 6},
                                               {3, 7},
                                               {4, 5},
                                               {4, 7},
                                               {5, 6},
                                               {6, 7},
                                               {0, 3, 2, 1},
                                               {0, 1, 5, 4},
                                               {0, 4, 7, 3},
                                               {1, 2, 6, 5},
                                               {2, 3, 7, 6},
                                               {4, 5, 6, 7},
                                               {0, 1, 2, 3, 4, 5, 6, 7}};
  const std::vector<std::vector<int>> hex_vtk{{0, 1},
                                              {1, 2},
                                              {2, 3},
                                              {3, 0},
                                              {4, 5},
                                              {5, 6},
                                              {6, 7},
                                              {7, 4},
                                              {0, 4},
                                              {1, 5},
                                              {2, 6},
                                              {3, 7},
                                              {0, 4, 7, 3},
                                              {1, 2, 6, 5},
                                              {0, 1, 5, 4},
                                              {3, 7, 6, 2},
                                              {0, 3, 2, 1},
                                              {4, 5, 6, 7},
                                              {0, 1, 2, 3, 4, 5, 6, 7}};
  const std::vector<std::vector<int>> wedge_gmsh{{0, 1}, {0, 2},       {0, 3},       {1, 2},
                                                 {1, 4}, {2, 5},       {3, 4},       {3, 5},
                                                 {4, 5}, {0, 1, 4, 3}, {0, 3, 5, 2}, {1, 2, 5, 4}};
  const std::vector<std::vector<int>> wedge_vtk{{0, 1}, {1, 2},       {2, 0},       {3, 4},
                                                {4, 5}, {5, 3},       {0, 3},       {1, 4},
                                                {2, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  const std::vector<std::vector<int>> pyramid_gmsh{{0, 1}, {0, 3}, {0, 4}, {1, 2},      {1, 4},
                                                   {2, 3}, {2, 4}, {3, 4}, {0, 1, 2, 3}};
  const std::vector<std::vector<int>> pyramid_vtk{{0, 1}, {1, 2}, {2, 3}, {3, 0},      {0, 4},
                                                  {1, 4}, {2, 4}, {3, 4}, {0, 1, 2, 3}};
  const std::vector<std::vector<int>> quad{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}};
  const auto first = [](const std::vector<std::vector<int>>& nodes, int count) {
    return std::vector(nodes.begin(), nodes.begin() + count);
  };
  return {{8, Shape::line, {{0, 1}}, {{0, 1}}},
          {9, Shape::triangle, {{0, 1}, {1, 2}, {2, 0}}, {{0, 1}, {1, 2}, {2, 0}}},
          {10, Shape::quad, quad, quad},
          {16, Shape::quad, first(quad, 4), first(quad, 4)},
          {11,
           Shape::tetrahedron,
           {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {2, 3}, {1, 3}},
           {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
          {12, Shape::hexahedron, hex_gmsh, hex_vtk},
          {17, Shape::hexahedron, first(hex_gmsh, 12), first(hex_vtk, 12)},
          {13, Shape::wedge, wedge_gmsh, wedge_vtk},
          {18, Shape::wedge, first(wedge_gmsh, 9), first(wedge_vtk, 9)},
          {14, Shape::pyramid, pyramid_gmsh, pyramid_vtk},
          {19, Shape::pyramid, first(pyramid_gmsh, 8), first(pyramid_vtk, 8)}};
}

Point middle(const std::vector<Point>& points, const std::vector<int>& of) {
  Point sum{};
  for (const int i : of) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += points[i][k] / static_cast<double>(of.size());
  }
  return sum;
}

/// A file of version 4.1 with one element, whose nodes are the points in their order.
std::string one_element(const SecondOrder& type, const std::vector<Point>& points, bool binary) {
  const std::size_t count = points.size();
  if (binary) {
    Bytes file(std::endian::native);
    file.text("$MeshFormat\n4.1 1 8\n").ints(1).text("\n$EndMeshFormat\n$Nodes\n");
    file.sizes(1, count, 1, count).ints(3, 1, 0).sizes(count);
    for (std::size_t i = 1; i <= count; ++i) file.sizes(i);
    for (const Point& point : points) file.reals(point[0], point[1], point[2]);
    file.text("\n$EndNodes\n$Elements\n").sizes(1, 1, 1, 1).ints(3, 1, type.type).sizes(1, 1);
    for (std::size_t i = 1; i <= count; ++i) file.sizes(i);
    return file.text("\n$EndElements\n").content();
  }
  std::string nodes;
  std::string places;
  std::string element = "1";
  for (std::size_t i = 0; i < count; ++i) {
    nodes += fmt::format("{}\n", i + 1);
    places += fmt::format("{} {} {}\n", points[i][0], points[i][1], points[i][2]);
    element += fmt::format(" {}", i + 1);
  }
  return fmt::format(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {0} 1 {0}\n3 1 0 {0}\n{1}{2}$EndNodes\n$Elements\n1 1 "
      "1 1\n"
      "3 1 {3} 1\n{4}\n$EndElements\n",
      count, nodes, places, type.type, element);
}

TEST(Gmsh, PutsMiddleNodesWhereVtkHasThem) {
  for (const SecondOrder& type : second_order()) {
    SCOPED_TRACE(type.type);
    // corners at powers of two: the means of all sets of corners are exact and distinct
    const int corner_count = corners(type.shape, 0);
    std::vector<Point> points;
    for (int i = 0; i < corner_count; ++i)
      points.push_back({static_cast<double>(8 << i), 64.0 * i, 8.0 * i * i});
    for (const auto& of : type.gmsh) points.push_back(middle(points, of));
    std::string content = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", points.size());
    std::string element = fmt::format("1 {} 0", type.type);
    for (std::size_t i = 0; i < points.size(); ++i) {
      content += fmt::format("{} {} {} {}\n", i + 1, points[i][0], points[i][1], points[i][2]);
      element += fmt::format(" {}", i + 1);
    }
    content += "$EndNodes\n$Elements\n1\n" + element + "\n$EndElements\n";

    for (const std::string& file :
         {content, one_element(type, points, false), one_element(type, points, true)}) {
      const Mesh mesh = read_text(file);
      ASSERT_EQ(mesh.cells.vertex_count(0), corner_count + static_cast<int>(type.vtk.size()));
      EXPECT_EQ(mesh.cells.shapes[0], type.shape);
      for (std::size_t k = 0; k < type.vtk.size(); ++k) {
        const Index node = mesh.cells[0][corner_count + k];
        EXPECT_EQ(mesh.points[node], middle(mesh.points, type.vtk[k])) << "node " << corner_count + k;
      }
      EXPECT_EQ(written(mesh), file);
    }
  }
}

TEST(Gmsh, HoldsCellsOfEveryTypeThatItHas) {
  const CellTypes types = common_types({{Shape::tetrahedron, 20},
                                        {Shape::tetrahedron, 35},
                                        {Shape::tetrahedron, 56},
                                        {Shape::triangle, 10},
                                        {Shape::triangle, 15},
                                        {Shape::triangle, 21},
                                        {Shape::line, 4},
                                        {Shape::line, 6},
                                        {Shape::quad, 16},
                                        {Shape::quad, 25},
                                        {Shape::hexahedron, 64},
                                        {Shape::hexahedron, 125},
                                        {Shape::wedge, 40},
                                        {Shape::pyramid, 14},
                                        {Shape::pyramid, 30}});
  for (const auto& [shape, count] : types) {
    SCOPED_TRACE(type_name(shape, count));
    const Mesh mesh = cells_of_type(shape, count, 3);
    const Mesh again = read_text(written(mesh));
    EXPECT_EQ(again.cells, mesh.cells);
    EXPECT_EQ(again.points, mesh.points);
  }
}

TEST(Gmsh, KeepsTheTypeOfSerendipityCells) {
  // types 36 and 40 are both quads of 16 nodes
  std::string content = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n16\n";
  for (int i = 1; i <= 16; ++i) content += fmt::format("{} {} {} 0\n", i, i, i * i);
  const std::string nodes = " 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n";
  content += "$EndNodes\n$Elements\n2\n1 36" + nodes + "2 40" + nodes + "$EndElements\n";
  EXPECT_EQ(written(read_text(content)), content);
}

TEST(Gmsh, RefusesCellsThatItLacks) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "mesh.msh";
  try {
    write_mesh(cells_of_type(Shape::polygon, 5, 2), path);
    FAIL() << "a polygon was written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("polygon"));
    EXPECT_THAT(error.what(), HasSubstr("mesh.msh"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

// ---- from other formats

TEST(Gmsh, LabelsOfNamedGroupsAreTheirNumbersAgain) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::array<std::array<Index, 3>, 4> faces{{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};
  for (const auto& face : faces) mesh.cells.push_back(Shape::triangle, face);
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.data.push_back(
      {std::string(kLabel), Association::cells, 1, std::vector<std::int32_t>{8, 9, 0, 4, 7}, {}, {}});
  mesh.sets = {{"wall", Association::cells, {0}},
               {"walls", Association::cells, {0, 1}},
               {"body", Association::cells, {4}},
               {"rest", Association::cells, {2, 3}}};
  const std::string file = written(mesh);
  // "rest" has a cell without a label: it gets a new number
  EXPECT_THAT(file,
              HasSubstr("$PhysicalNames\n4\n2 8 \"wall\"\n2 9 \"walls\"\n3 7 \"body\"\n2 10 \"rest\"\n"));
  const Mesh again = read_text(file);
  for (const EntitySet& set : mesh.sets) EXPECT_EQ(set_of(again, set.name).members, set.members);
  EXPECT_EQ(find_array(again, kLabel, Association::cells)->values,
            Values(std::vector<std::int32_t>{8, 9, 10, 4, 7}));
}

TEST(Gmsh, LabelsOfSomeCellsAreGroupsOfThese) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 1, 2});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 1, 3});
  mesh.data.push_back(
      {std::string(kLabel), Association::cells, 1, std::vector<std::int32_t>{8, 3}, {2, 1}, {}});
  const Mesh again = read_text(written(mesh));
  EXPECT_EQ(find_array(again, kLabel, Association::cells)->values,
            Values(std::vector<std::int32_t>{0, 3, 8}));
}

/// EXPECTs the same mesh within the limits of Gmsh's format: data are double, sets of vertices are left out.
void expect_converted(const Mesh& actual, const Mesh& expected) {
  EXPECT_EQ(actual.points, expected.points);
  EXPECT_EQ(actual.cells, expected.cells);
  for (const DataArray& array : expected.data) {
    const DataArray* found = find_array(actual, array.name, array.association);
    ASSERT_TRUE(found) << array.name;
    EXPECT_EQ(found->values, array.values) << array.name;
    EXPECT_EQ(found->components, array.components) << array.name;
  }
  for (const EntitySet& set : expected.sets) {
    if (set.association == Association::cells) {
      EXPECT_EQ(set_of(actual, set.name).members, set.members);
    }
  }
}

TEST(Gmsh, HoldsAMeshFromElsewhere) {
  for (const Mesh& mesh : {mixed_mesh(), tetrahedral_bar(5)}) {
    Notes notes;
    const std::string content = written(mesh, &notes);
    EXPECT_THAT(notes, ElementsAre("the set 'fixed' of vertices is not written: Gmsh cannot hold it"));
    const Mesh again = read_text(content);
    expect_converted(again, mesh);
    EXPECT_EQ(written(again), content);
    // the order counts more than the blocks: later orders may mix types again
    EXPECT_THAT(again.cell_blocks, IsEmpty());
  }
}

TEST(Gmsh, WritesAMeshFromElsewhereInVersion41) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{1, 2, 3, 4});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 2, 1});
  mesh.data.push_back({std::string(kLabel), Association::cells, 1, Ints{5, 2, 0}, {}, {}});
  mesh.data.push_back(
      {"uv", Association::vertices, 2, std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10.5F}, {}, {}});
  mesh.sets.push_back({"a \"set\"", Association::cells, {2, 1}});
  mesh.vertex_ids = {0, 1, 2, 3, 4};
  Notes notes;
  EXPECT_EQ(
      written(mesh, &notes),
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
      "$PhysicalNames\n2\n2 6 \"a 'set'\"\n3 6 \"a 'set'\"\n$EndPhysicalNames\n"
      "$Entities\n0 0 1 2\n1 0 0 0 1 1 0 1 6 0\n2 0 0 0 1 1 1 2 2 6 0\n5 0 0 0 1 1 1 1 5 0\n$EndEntities\n"
      "$Nodes\n1 5 1 5\n3 2 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n"
      "$Elements\n3 3 1 3\n3 5 4 1\n1 1 2 3 4\n3 2 4 1\n2 2 3 4 5\n2 1 2 1\n3 1 3 2\n$EndElements\n"
      "$NodeData\n1\n\"uv\"\n1\n0\n3\n0\n3\n5\n1 1 2 0\n2 3 4 0\n3 5 6 0\n4 7 8 0\n5 9 10.5 "
      "0\n$EndNodeData\n");
  EXPECT_THAT(notes, ElementsAre("the vertices are renumbered: Gmsh's numbers are positive and distinct",
                                 "the set 'a \"set\"' is written as 'a 'set''",
                                 HasSubstr("'uv' is filled up with zeros")));
}

TEST(Gmsh, NotesWhatItCannotHold) {
  Mesh mesh = tetrahedral_bar(1);
  mesh.data.clear();
  mesh.sets.clear();
  mesh.data.push_back({std::string(kLabel), Association::cells, 1, Ints{-1, 1, 1, 1, 1, 1}, {}, {}});
  mesh.data.push_back({"names", Association::cells, 1, std::vector<std::string>(6, "a"), {}, {}});
  mesh.data.push_back({"wide", Association::cells, 10, Reals(60), {}, {}});
  mesh.data.push_back(
      {"big", Association::cells, 1, std::vector<std::int64_t>(6, (std::int64_t{1} << 53) + 1), {}, {}});
  Notes notes;
  const Mesh again = read_text(written(mesh, &notes));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("labels of cells are written as data"), HasSubstr("'names'"),
                                 HasSubstr("'wide'"), HasSubstr("'big' loses digits")));
  EXPECT_EQ(values<std::int32_t>(again, kLabel, Association::cells), (Ints{-1, 1, 1, 1, 1, 1}));
}

TEST(Gmsh, FindsItsEntitiesAgainAfterADetour) {
  // another format keeps arrays and sets, but not the other sections of Gmsh's file
  Mesh mesh = read_text(kGmsh41);
  mesh.format_metadata.reset();
  mesh.cell_blocks.clear();
  std::erase_if(mesh.sets, [](const EntitySet& set) { return set.association == Association::vertices; });
  const Mesh again = read_text(written(mesh));
  EXPECT_EQ(values<std::int32_t>(again, "gmsh:geometrical", Association::cells), (Ints{3, 5, 6}));
  EXPECT_EQ(values<std::int32_t>(again, "gmsh:dim_tags", Association::vertices),
            values<std::int32_t>(mesh, "gmsh:dim_tags", Association::vertices));
  EXPECT_EQ(*find_array(again, "gmsh:parametric", Association::vertices),
            *find_array(mesh, "gmsh:parametric", Association::vertices));
  EXPECT_EQ(values<std::int32_t>(again, kLabel, Association::cells), (Ints{7, 4, 9}));
  EXPECT_EQ(set_of(again, "all of it").members, set_of(mesh, "all of it").members);
}

TEST(Gmsh, LeavesNoFileWhenTheTargetCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_mesh(tetrahedral_bar(1), folder.path() / "absent" / "mesh.msh"), InputError);
  std::filesystem::create_directory(folder.path() / "mesh.msh");
  EXPECT_THROW(write_mesh(tetrahedral_bar(1), folder.path() / "mesh.msh"), InputError);
  EXPECT_THAT(folder.names(), ElementsAre("mesh.msh"));
}

}  // namespace
}  // namespace meshorder::test
