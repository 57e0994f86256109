// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view kReal =
    "%%MatrixMarket matrix coordinate real general\n"
    "% made by hand\n"
    "%\n"
    "4 4 6\n"
    "1 1 2.5\n"
    "2 1 -1e-20\n"
    "1 2 0\n"
    "3 3 7\n"
    "4 2 1\n"
    "2 2 8\n";

// a path of 1, 2 and 3, and vertex 4 alone
constexpr std::string_view kGraph =
    "% made by hand\n"
    "4 2 111 2\n"
    "9 1 2 2 30\n"
    "8 3 4 1 30 3 40\n"
    "7 5 6 2 40\n"
    "6 7 8\n";

Mesh read_as(const std::string& name, std::string_view content, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  return read_mesh(folder.file(name, content), {.notes = notes});
}

std::string text_of(const Mesh& mesh, const std::string& name, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / name, notes);
  return test::content_of(folder.path() / name);
}

std::string symmetric(std::string_view symmetry, std::string_view field, std::string_view entries) {
  return "%%MatrixMarket matrix coordinate " + std::string(field) + " " + std::string(symmetry) + "\n" +
         std::string(entries);
}

/// The mesh with the vertices in the opposite order.
Mesh turned(Mesh mesh) {
  std::vector<Index> places;
  for (Index v = mesh.vertex_count(); v-- > 0;) places.push_back(v);
  apply_reordering(mesh, Permutation::from_old_to_new(std::move(places)),
                   Permutation::identity(mesh.cell_count()));
  return mesh;
}

/// The file that is left after turning the vertices round, writing, reading and turning them back.
std::string turned_twice(const std::string& name, std::string_view content) {
  const std::string once = text_of(turned(read_as(name, content)), name);
  EXPECT_NE(once, content);
  return text_of(turned(read_as(name, once)), name);
}

TEST(MatrixMarket, EntriesAreLinesAndOnTheDiagonalVertices) {
  Notes notes;
  const Mesh mesh = read_as("a.mtx", kReal, &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("is not symmetric")));
  EXPECT_EQ(mesh.vertex_count(), 4);
  EXPECT_THAT(mesh.cells.shapes, ElementsAre(Shape::vertex, Shape::line, Shape::line, Shape::vertex,
                                             Shape::line, Shape::vertex));
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 1, 0, 0, 1, 2, 3, 1, 1));
  const DataArray* const values = find_array(mesh, "value", Association::cells);
  ASSERT_NE(values, nullptr);
  EXPECT_THAT(std::get<std::vector<double>>(values->values), ElementsAre(2.5, -1e-20, 0, 7, 1, 8));
}

TEST(MatrixMarket, WritesTheSameFileAgain) {
  const std::array files{
      std::string(kReal),
      symmetric("general", "pattern", "3 3 4\n1 2\n2 1\n3 3\n1 3\n"),
      symmetric("symmetric", "integer", "3 3 3\n2 1 -9007199254740993\n3 2 4\n3 3 5\n"),
      symmetric("skew-symmetric", "real", "3 3 2\n2 1 1.5\n3 1 -2\n"),
      symmetric("hermitian", "complex", "3 3 3\n1 1 3 0\n2 1 1.5 -2\n3 2 0 1\n"),
  };
  test::expect_order_and_back_to("a.mtx", kReal);
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    EXPECT_EQ(text_of(read_as("a.mtx", file), "a.mtx"), file);
    EXPECT_EQ(turned_twice("a.mtx", file), file);
  }
}

TEST(MatrixMarket, MovesRowsAndColumnsTogether) {
  const auto of = [](std::string_view symmetry, std::string_view field, std::string_view entries) {
    const std::string text = text_of(turned(read_as("a.mtx", symmetric(symmetry, field, entries))), "a.mtx");
    return text.substr(text.find('\n') + 1);
  };
  EXPECT_EQ(of("general", "real", "3 3 2\n1 2 5\n3 3 1\n"), "3 3 2\n3 2 5\n1 1 1\n");
  // one half is stored, so an entry that leaves it is turned round
  EXPECT_EQ(of("symmetric", "real", "3 3 1\n2 1 5\n"), "3 3 1\n3 2 5\n");
  EXPECT_EQ(of("skew-symmetric", "integer", "3 3 1\n2 1 5\n"), "3 3 1\n3 2 -5\n");
  EXPECT_EQ(of("hermitian", "complex", "3 3 1\n2 1 5 6\n"), "3 3 1\n3 2 5 -6\n");
  EXPECT_EQ(of("skew-symmetric", "complex", "3 3 1\n2 1 5 6\n"), "3 3 1\n3 2 -5 -6\n");
}

TEST(MatrixMarket, RefusesBrokenFiles) {
  const std::string file(kReal);
  const std::string head = "%%MatrixMarket matrix coordinate real general\n";
  test::expect_broken(
      "a.mtx", {
                   {"no banner", file.substr(file.find('\n') + 1), ":1: is no Matrix Market file"},
                   {"vector", with(file, "matrix", "vector"), ":1: holds a 'vector'"},
                   {"dense", with(file, "coordinate", "array"), ":1: the matrix is stored as 'array'"},
                   {"field", with(file, "real", "quaternion"), ":1: the field of the matrix is 'quaternion'"},
                   {"symmetry", with(file, "general", "nice"), ":1: the symmetry of the matrix is 'nice'"},
                   {"rectangular", with(file, "4 4 6", "4 5 6"),
                    ":4: the matrix has 4 rows and 5 columns; only a square"},
                   {"huge", head + "2000000000 2000000000 1\n1 1 1\n",
                    ":2: the number of rows is 2000000000, but only"},
                   {"many entries", with(file, "4 4 6", "4 4 600000000"),
                    ":4: the number of entries is 600000000, but"},
                   {"negative", with(file, "4 4 6", "-4 -4 6"), ":4: the number of rows is -4"},
                   {"fewer", with(file, "4 4 6", "4 4 7"), "unexpected end of file"},
                   {"more", with(file, "4 4 6", "4 4 5"), ":10: more entries"},
                   {"row 0", with(file, "3 3 7", "0 3 7"), ":8: a row is 0; 1 to 4"},
                   {"column 5", with(file, "3 3 7", "3 5 7"), ":8: a column is 5; 1 to 4"},
                   {"word", with(file, "3 3 7", "3 3 x"), ":8: a value is 'x'"},
                   {"four numbers", with(file, "3 3 7", "3 3 7 1"), ":8: the line of an entry has too many"},
                   {"none", head + "3 3 0\n", "has no cells"},
                   {"no number of rows", head + "x 3 0\n", ":2: the number of rows is 'x'"},
                   {"cut", head, "unexpected end of file"},
               });
}

TEST(MatrixMarket, OtherMeshesOfLinesAreMatrices) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.cells.push_back(Shape::line, std::array<Index, 2>{0, 1});
  mesh.cells.push_back(Shape::line, std::array<Index, 2>{2, 1});
  Notes notes;
  EXPECT_EQ(text_of(mesh, "a.mtx", &notes),
            "%%MatrixMarket matrix coordinate pattern symmetric\n3 3 2\n2 1\n3 2\n");
  EXPECT_THAT(notes, ElementsAre(HasSubstr("coordinates of vertices")));
  mesh.cells.push_back(Shape::line, std::array<Index, 2>{1, 0});
  EXPECT_THAT(text_of(mesh, "a.mtx"), HasSubstr("pattern general\n3 3 3\n1 2\n3 2\n2 1\n"));
  const TemporaryFolder folder;
  EXPECT_THAT(test::write_error(test::tetrahedral_bar(1), folder.path() / "a.mtx"), HasSubstr("tetrahedron"));
  EXPECT_THAT(test::write_error(test::tetrahedral_bar(1), folder.path() / "a.graph"),
              HasSubstr("tetrahedron"));
}

TEST(MatrixMarket, IsToldByItsBytes) { EXPECT_EQ(format_of_bytes(kReal)->name, "MatrixMarket"); }

TEST(MetisGraph, ReadsEdgesOnceWithAllWeights) {
  const Mesh mesh = read_as("a.graph", kGraph);
  EXPECT_EQ(mesh.vertex_count(), 4);
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 1, 1, 2));
  const auto numbers = [&](std::string_view name, Association association) {
    return std::get<std::vector<std::int64_t>>(find_array(mesh, name, association)->values);
  };
  EXPECT_THAT(numbers("weight", Association::cells), ElementsAre(30, 40));
  EXPECT_THAT(numbers("weight", Association::vertices), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(numbers("size", Association::vertices), ElementsAre(9, 8, 7, 6));
}

TEST(MetisGraph, WritesTheSameFileAgain) {
  for (const std::string_view file :
       {kGraph, std::string_view("3 1\n2\n1\n\n"), std::string_view("3 1 001\n2 5\n1 5\n\n"),
        std::string_view("2 1 010\n4 2\n3 1\n"), std::string_view("2 1 100\n4 2\n3 1\n")}) {
    SCOPED_TRACE(file);
    EXPECT_EQ(text_of(read_as("a.graph", file), "a.graph"), file);
    EXPECT_EQ(turned_twice("a.graph", file), file);
  }
}

TEST(MetisGraph, MovesListsAndWeights) {
  EXPECT_EQ(text_of(turned(read_as("a.graph", kGraph)), "a.graph"),
            "% made by hand\n4 2 111 2\n6 7 8\n7 5 6 3 40\n8 3 4 2 40 4 30\n9 1 2 3 30\n");
}

TEST(MetisGraph, LeavesOutWhatAGraphHasNot) {
  Notes notes;
  EXPECT_EQ(text_of(read_as("a.mtx", kReal), "a.graph", &notes), "4 2\n2\n1 4\n\n2\n");
  EXPECT_THAT(notes,
              testing::IsSupersetOf(
                  {HasSubstr("3 vertices are left out"), HasSubstr("1 lines that join vertices once more"),
                   HasSubstr("array 'value' on cells is not written"), HasSubstr("the matrix's comments")}));
  EXPECT_EQ(text_of(read_as("a.graph", kGraph), "a.mtx"),
            "%%MatrixMarket matrix coordinate integer symmetric\n4 4 2\n2 1 30\n3 2 40\n");
}

TEST(MetisGraph, NeedsAnEdge) {
  const TemporaryFolder folder;
  EXPECT_THAT(test::write_error(test::cells_of_type(Shape::vertex, 1, 2), folder.path() / "a.graph"),
              HasSubstr("METIS cannot hold a cell of type vertex"));
  Mesh loop = test::cells_of_type(Shape::line, 2, 1);
  loop.cells.vertices = {0, 0};
  EXPECT_THAT(test::write_error(loop, folder.path() / "a.graph"), HasSubstr("no line between two vertices"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(MetisGraph, RefusesBrokenFiles) {
  const std::string file(kGraph);
  test::expect_broken(
      "a.graph",
      {
          {"digits", with(file, "111 2", "121 2"), ":2: the third number is '121'"},
          {"weights", with(file, "111 2", "101 2"), ":2: the number of weights"},
          {"no weights", with(file, "111 2", "111 0"), ":2: the number of weights"},
          {"five numbers", with(file, "111 2", "111 2 1"), ":2: the first line has too many"},
          {"huge", with(file, "4 2 1", "2000000000 2 1"), ":2: the number of vertices is 2000000000"},
          {"many edges", with(file, "4 2 1", "4 2000000 1"), ":2: the number of edges is 2000000"},
          {"edges", with(file, "4 2 1", "4 3 1"), "promises 3 edges, but the lists name 4"},
          {"more lines", with(file, "4 2 1", "3 2 1"), ":6: more than 3 lines"},
          {"cut", with(file, "6 7 8\n", ""), "only 3 of 4 lines"},
          {"itself", with(file, "2 30", "1 30"), ":3: the vertex names itself"},
          {"range", with(file, "2 30", "5 30"), ":3: a neighbour is 5; 1 to 4"},
          {"one side", with(file, "5 6 2 40", "5 6 1 40"), ":4: vertex 2 names 3, which does not"},
          {"other weight", with(file, "5 6 2 40", "5 6 2 41"), ":4: vertex 2 names 3"},
          {"no weight", with(file, "2 30", "2"), ":3: the line ends before the weight of an edge"},
          {"no weight of the vertex", with(file, "6 7 8", "6 7"), ":6: the line ends before the weight"},
          {"zero", with(file, "2 30", "2 0"), ":3: the weight of an edge is 0"},
          {"twice", "2 2\n2 2\n1 1\n", ":2: the vertex names 2 twice"},
          {"word", with(file, "2 30", "x 30"), ":3: a neighbour is 'x'"},
          {"no edges", "2 0\n\n\n", "has no cells"},
      });
}

}  // namespace
}  // namespace meshorder
