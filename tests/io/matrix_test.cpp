// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/matrix/matrix.hpp"

#include "io/format.hpp"
#include "io/npy.hpp"
#include "mesh/stored_matrix.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

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

// a path of 1, 2 and 3, and the isolated vertex 4
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

/// The file after reversing the vertices, writing, reading, and reversing them again.
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

TEST(MatrixMarket, WritesWholeNumbersOfAllTypesInFull) {
  Mesh mesh = read_as("a.mtx", kReal);
  DataArray& values =
      mesh.data[static_cast<std::size_t>(find_array(mesh, "value", Association::cells) - mesh.data.data())];
  values.values = std::vector<std::uint64_t>{9007199254740993, 1, 2, 3, 4, 5};
  EXPECT_THAT(text_of(mesh, "a.mtx"), HasSubstr("9007199254740993"));
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
  // one half is stored: an entry that moves to the other half is transposed
  EXPECT_EQ(of("symmetric", "real", "3 3 1\n2 1 5\n"), "3 3 1\n3 2 5\n");
  EXPECT_EQ(of("skew-symmetric", "integer", "3 3 1\n2 1 5\n"), "3 3 1\n3 2 -5\n");
  EXPECT_EQ(of("hermitian", "complex", "3 3 1\n2 1 5 6\n"), "3 3 1\n3 2 5 -6\n");
  EXPECT_EQ(of("skew-symmetric", "complex", "3 3 1\n2 1 5 6\n"), "3 3 1\n3 2 -5 -6\n");
}

TEST(MatrixMarket, NotesCommentsBetweenTheEntries) {
  Notes notes;
  const std::string banner = "%%MatrixMarket matrix coordinate pattern general\n% kept\n";
  (void)read_as("a.mtx", banner + "2 2 2\n1 2\n2 1\n", &notes);
  EXPECT_THAT(notes, IsEmpty());
  (void)read_as("a.mtx", banner + "2 2 2\n1 2 % first\n2 1\n", &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("a.mtx: comments between the entries are left out")));
}

TEST(MatrixMarket, RefusesBrokenFiles) {
  const std::string file(kReal);
  const std::string head = "%%MatrixMarket matrix coordinate real general\n";
  test::expect_broken(
      "a.mtx",
      {
          {"no banner", file.substr(file.find('\n') + 1), ":1: is not a Matrix Market file"},
          {"vector", with(file, "matrix", "vector"), ":1: holds a 'vector'"},
          {"dense", with(file, "coordinate", "array"), ":1: the matrix is stored as 'array'"},
          {"field", with(file, "real", "quaternion"), ":1: the field of the matrix is 'quaternion'"},
          {"symmetry", with(file, "general", "nice"), ":1: the symmetry of the matrix is 'nice'"},
          {"rectangular", with(file, "4 4 6", "4 5 6"),
           ":4: the matrix has 4 rows and 5 columns; only a square"},
          {"no sizes", head + "2 1\n3 2\n4 3\n",
           ":2: the line of sizes has 2 numbers; three are needed: rows, columns and entries"},
          {"one size", head + "3 % rows\n3 3\n", ":2: the line of sizes has 1 number; three"},
          {"four sizes", with(file, "4 4 6", "4 4 6 1"), ":4: the line of sizes has too many numbers"},
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
          {"none", head + "3 3 0\n", "has no entries; a matrix needs at least one"},
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

TEST(MatrixMarket, IsKnownByItsBytes) { EXPECT_EQ(format_of_bytes(kReal)->name, "MatrixMarket"); }

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
                  {HasSubstr("3 vertices are left out"), HasSubstr("1 repeated lines are not written"),
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
          {"cut at the end", "4 3\n2\n1 3\n2 4\n", "a.graph:4: only 3 of 4 lines"},
          {"itself", with(file, "2 30", "1 30"), ":3: the vertex names itself"},
          {"range", with(file, "2 30", "5 30"), ":3: a neighbour is 5; 1 to 4"},
          {"one side", with(file, "5 6 2 40", "5 6 1 40"), ":4: vertex 2 names 3, which does not"},
          {"other weight", with(file, "5 6 2 40", "5 6 2 41"), ":4: vertex 2 names 3"},
          {"no weight", with(file, "2 30", "2"), ":3: the line ends before the weight of an edge"},
          {"no weight of the vertex", with(file, "6 7 8", "6 7"), ":6: the line ends before the weight"},
          {"zero", with(file, "2 30", "2 0"), ":3: the weight of an edge is 0"},
          {"twice", "2 2\n2 2\n1 1\n", ":2: the vertex names 2 twice"},
          {"word", with(file, "2 30", "x 30"), ":3: a neighbour is 'x'"},
          {"no edges", "2 0\n\n\n", "has no edges; a graph needs at least one"},
      });
}

TEST(StoredMatrix, IsWhatTheReaderSays) {
  const Mesh general = read_as("a.mtx", kReal);
  ASSERT_NE(stored_matrix(general), nullptr);
  EXPECT_FALSE(stored_matrix(general)->is_half);
  EXPECT_FALSE(stored_matrix(general)->is_graph);
  EXPECT_EQ(stored_matrix(general)->field, "real");
  EXPECT_EQ(stored_matrix(general)->symmetry, "general");
  for (const std::string_view symmetry : {"symmetric", "skew-symmetric", "hermitian"}) {
    const Mesh half = read_as("a.mtx", symmetric(symmetry, "complex", "3 3 1\n2 1 5 0\n"));
    ASSERT_NE(stored_matrix(half), nullptr);
    EXPECT_TRUE(stored_matrix(half)->is_half) << symmetry;
    EXPECT_EQ(stored_matrix(half)->symmetry, symmetry);
    EXPECT_EQ(stored_matrix(half)->field, "complex");
    EXPECT_EQ(entry_pattern(half).entries(), 2);
  }
  const Mesh graph = read_as("a.graph", kGraph);
  ASSERT_NE(stored_matrix(graph), nullptr);
  EXPECT_TRUE(stored_matrix(graph)->is_graph && stored_matrix(graph)->is_half);
  EXPECT_NE(stored_matrix(turned(graph)), nullptr);
  EXPECT_EQ(stored_matrix(test::tetrahedral_bar(1)), nullptr);
  EXPECT_EQ(stored_matrix(read_as("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), nullptr);
}

TEST(StoredMatrix, IsWrittenWithoutAWordOfPointsThatWereGiven) {
  Mesh mesh = read_as("a.mtx", kReal);
  mesh.points[2] = {1, 2, 3};
  for (const char* const name : {"b.mtx", "b.graph"}) {
    Notes notes;
    (void)text_of(mesh, name, &notes);
    EXPECT_THAT(notes, testing::Each(testing::Not(HasSubstr("coordinates")))) << name;
  }
}

const std::vector<Point> kThree{{0.5, 1, -2}, {3, 4e2, 5}, {6, 7, 8}};
const std::vector<Point> kFlat{{0.5, 1, 0}, {3, 4e2, 0}, {6, 7, 0}};

RowPoints points_in(std::string_view content, Index rows = 3) {
  const TemporaryFolder folder;
  return read_points(folder.file("points", content), rows);
}

/// A NumPy array of three rows.
template <class Number>
std::string numpy_points(const std::string& type, int columns, bool columns_first) {
  std::string bytes = npy_header(type, std::array<std::int64_t, 2>{3, columns});
  if (columns_first) bytes = with(bytes, "'fortran_order': False", "'fortran_order': True ");
  const auto put = [&](double coordinate) {
    const auto number = static_cast<Number>(coordinate);
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), &number, sizeof(Number));
    if (type[0] == '>') std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
  };
  for (int a = 0; a < (columns_first ? columns : 3); ++a) {
    for (int b = 0; b < (columns_first ? 3 : columns); ++b) put(columns_first ? kThree[b][a] : kThree[a][b]);
  }
  return bytes;
}

TEST(RowPoints, AreReadFromText) {
  for (const std::string_view file :
       {"0.5 1 -2\n3 4e2 5\n6 7 8\n", "# by hand\n\n  0.5,1,\t-2 % the first\r\n3 , 4e2,5\r\n6 7 8",
        "% x y z\n0.5 1 -2\n3 400 5\n6 7 8\n\n# end\n"}) {
    const RowPoints read = points_in(file);
    EXPECT_EQ(read.points, kThree) << file;
    EXPECT_EQ(read.dimension, 3);
  }
  EXPECT_EQ(points_in("0.5 1\n3,4e2\n6 7\n").points, kFlat);
  EXPECT_EQ(points_in("0.5 1\n3,4e2\n6 7\n").dimension, 2);
}

TEST(RowPoints, AreReadFromNumPy) {
  for (const bool columns_first : {false, true}) {
    EXPECT_EQ(points_in(numpy_points<double>("<f8", 3, columns_first)).points, kThree);
    EXPECT_EQ(points_in(numpy_points<double>(">f8", 3, columns_first)).points, kThree);
    EXPECT_EQ(points_in(numpy_points<float>("<f4", 2, columns_first)).points, kFlat);
    EXPECT_EQ(points_in(numpy_points<float>("<f4", 2, columns_first)).dimension, 2);
  }
}

TEST(RowPoints, AreReadFromADenseArray) {
  EXPECT_EQ(
      points_in("%%MatrixMarket matrix array real general\n% by hand\n3 3\n0.5\n3\n6\n1\n400\n7\n-2\n5\n8\n")
          .points,
      kThree);
  EXPECT_EQ(points_in("%%matrixmarket MATRIX array real general\n3 2\n0.5 3 6 1 400 7\n").points, kFlat);
}

TEST(RowPoints, RefuseBrokenFiles) {
  const std::string numpy = numpy_points<double>("<f8", 3, false);
  const std::string array = "%%MatrixMarket matrix array real general\n3 2\n1\n2\n3\n4\n5\n6\n";
  const std::vector<std::pair<std::string, std::string>> broken{
      {"1 2 3\n4 5 6\n", ":3: has 2 rows of coordinates, where 3 are needed; give a row"},
      {"1 2 3\n4 5 6\n7 8 9\n1 2 3\n", ":4: has more rows of coordinates, where 3 are needed"},
      {"1 2 3\n4 5\n7 8 9\n", ":2: the row has 2 numbers, those before it 3"},
      {"1\n2\n3\n", ":1: the row has 1 numbers; give a row of 2 or 3"},
      {"1 2 3 4\n", ":1: the row has 4 numbers"},
      {"1 2 3\n4 nan 6\n7 8 9\n", ":2: a coordinate is nan; finite numbers"},
      {"1 2 3\n4 inf 6\n7 8 9\n", ":2: a coordinate is inf; finite numbers"},
      {"1 2 3\n4 1e999 6\n7 8 9\n", ":2: a coordinate is 1e999; it is too large"},
      {"x y z\n1 2 3\n", ":1: a coordinate is 'x'; a number is needed"},
      {"1,,3\n", ":1: a coordinate is ''"},
      {"1,2,\n", ":1: a coordinate is ''"},
      {"1 2\n1 2\n1 2\n", "all points are the same"},
      {"# nothing\n", "has 0 rows of coordinates"},
      {numpy.substr(0, numpy.size() - 1), "a coordinate"},
      {numpy + "x", "continues after the last number"},
      {numpy_points<double>("<i8", 3, false), "holds '<i8'; 32- or 64-bit real numbers"},
      {with(numpy, "(3, 3)", "(3, 4)"), "a row has 4 numbers"},
      {with(numpy, "(3, 3)", "(9, 1)"), "a row has 1 numbers"},
      {with(numpy, "(3, 3)", "(4, 3)"), "has 4 rows of coordinates, where 3"},
      {with(numpy, "(3, 3)", "(9,)  "), "is an array of 1 dimensions"},
      {with(array, "array real", "coordinate real"), ":1: the first line has 'coordinate' where 'array'"},
      {with(array, "real", "complex"), ":1: the array is of the field 'complex'"},
      {with(array, "general", "symmetric"), ":1: the array is 'symmetric'"},
      {with(array, "3 2", "4 2"), ":2: has 4 rows of coordinates"},
      {with(array, "3 2", "3 1"), ":2: a row has 1 numbers"},
      {with(array, "5\n", ""), "a coordinate"},
      {array + "7\n", "more numbers than the sizes say"},
      {with(array, "4\n", "nan\n"), ":6: a coordinate is not finite"},
  };
  for (const auto& [content, expected] : broken) {
    try {
      (void)points_in(content);
      ADD_FAILURE() << "is read: " << expected;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(expected));
    }
  }
}

}  // namespace
}  // namespace meshorder
