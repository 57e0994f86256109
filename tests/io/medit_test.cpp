// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "mesh/reorder.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

namespace meshorder {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::string_view kFile =
    "# made by hand\n"
    "MeshVersionFormatted 1\n"
    "Dimension\n3\n"
    "Identifier\n\"two # tetrahedra\"\n"
    "\n"
    "Vertices\n5\n"
    "0 0 0 1\n"
    "1 0 0 2\n"
    "0 1 0 3   # a comment\n"
    "0 0 1 4\n"
    "1 1 1.5e0 -5\n"
    "Corners 2\n5\n1\n"
    "Edges\n2\n1 2 8\n2 3 9\n"
    "Ridges\n1\n2\n"
    "Triangles\n2\n1 2 3 6\n3 4 5 7\n"
    "RequiredTriangles\n2\n2 1\n"
    "Quadrilaterals\n0\n"
    "Tetrahedra\n2\n1 2 3 4 10\n2 3 4 5 20\n"
    "Normals\n2\n0 0 1\n1 0 0\n"
    "NormalAtVertices\n3\n4 1\n2 2\n5 1\n"
    "VertexOnGeometricEdge\n1\n3 7 0.25\n"
    "BoundingBox\n0 0 0 1 1 1.5\n"
    "End\n"
    "# fin\n";

template <class T>
const std::vector<T>& values(const Mesh& mesh, std::string_view name, Association association) {
  return std::get<std::vector<T>>(find_array(mesh, name, association)->values);
}

Mesh read(std::string_view content, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  return read_mesh(folder.file("m.mesh", content), {.notes = notes});
}

std::string written(const Mesh& mesh, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "m.mesh", notes);
  return test::content_of(folder.path() / "m.mesh");
}

std::string replaced(std::string_view text, std::string_view old, std::string_view by) {
  std::string result(text);
  const std::size_t at = result.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return result.replace(at, old.size(), by);
}

TEST(Medit, ReadsEverySectionOfAFile) {
  Notes notes;
  const Mesh mesh = read(kFile, &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("m.mesh: comments between the data are left out")));
  EXPECT_EQ(mesh.points[4], (Point{1, 1, 1.5}));
  EXPECT_THAT(mesh.cells.shapes, ElementsAre(Shape::line, Shape::line, Shape::triangle, Shape::triangle,
                                             Shape::tetrahedron, Shape::tetrahedron));
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 1, 1, 2, 0, 1, 2, 2, 3, 4, 0, 1, 2, 3, 1, 2, 3, 4));
  EXPECT_THAT(mesh.cell_blocks, ElementsAre(0, 2, 4));
  EXPECT_THAT(values<std::int32_t>(mesh, kLabel, Association::vertices), ElementsAre(1, 2, 3, 4, -5));
  EXPECT_THAT(values<std::int32_t>(mesh, kLabel, Association::cells), ElementsAre(8, 9, 6, 7, 10, 20));

  ASSERT_EQ(mesh.sets.size(), 3U);
  EXPECT_EQ(mesh.sets[0], (EntitySet{"Corners", Association::vertices, {4, 0}}));
  EXPECT_EQ(mesh.sets[1], (EntitySet{"Ridges", Association::cells, {1}}));
  EXPECT_EQ(mesh.sets[2], (EntitySet{"RequiredTriangles", Association::cells, {3, 2}}));

  EXPECT_THAT(find_array(mesh, "NormalAtVertices", Association::vertices)->indices, ElementsAre(3, 1, 4));
  EXPECT_THAT(values<double>(mesh, "NormalAtVertices", Association::vertices), ElementsAre(1, 2, 1));
  EXPECT_THAT(values<double>(mesh, "VertexOnGeometricEdge", Association::vertices), ElementsAre(7, 0.25));
}

TEST(Medit, WritesAFileAsItWas) {
  const Mesh mesh = read(kFile);
  const std::string text = written(mesh);
  EXPECT_EQ(text,
            "# made by hand\n"
            "MeshVersionFormatted 1\n"
            "Dimension 3\n"
            "\nIdentifier\n\"two # tetrahedra\"\n"
            "\n\nVertices\n5\n0 0 0 1\n1 0 0 2\n0 1 0 3\n0 0 1 4\n1 1 1.5 -5\n"
            "\nEdges\n2\n1 2 8\n2 3 9\n"
            "\nTriangles\n2\n1 2 3 6\n3 4 5 7\n"
            "\nTetrahedra\n2\n1 2 3 4 10\n2 3 4 5 20\n"
            "\nQuadrilaterals\n0\n"
            "\nCorners\n2\n5\n1\n"
            "\nRidges\n1\n2\n"
            "\nRequiredTriangles\n2\n2\n1\n"
            "\nNormalAtVertices\n3\n4 1\n2 2\n5 1\n"
            "\nVertexOnGeometricEdge\n1\n3 7 0.25\n"
            "\nNormals\n2\n0 0 1\n1 0 0\n"
            "\nBoundingBox\n0 0 0 1 1 1.5\n"
            "\nEnd\n# fin\n");
  Notes notes;
  test::expect_same(read(text, &notes), mesh);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_EQ(written(read(text)), text);
}

TEST(Medit, PositionsFollowTheNewOrder) {
  const TemporaryFolder folder;
  test::expect_order_and_back(folder.file("m.mesh", kFile));
  Mesh mesh = read(kFile);
  apply_reordering(mesh, Permutation::from_old_to_new({4, 3, 2, 1, 0}),
                   Permutation::from_old_to_new({1, 0, 3, 2, 4, 5}));
  const std::string text = written(mesh);
  EXPECT_THAT(text, HasSubstr("\nTriangles\n2\n3 2 1 7\n5 4 3 6\n"));
  EXPECT_THAT(text, HasSubstr("\nCorners\n2\n1\n5\n"));
  EXPECT_THAT(text, HasSubstr("\nRidges\n1\n1\n"));
  EXPECT_THAT(text, HasSubstr("\nRequiredTriangles\n2\n1\n2\n"));
  EXPECT_THAT(text, HasSubstr("\nNormalAtVertices\n3\n2 1\n4 2\n1 1\n"));
}

// a square of two triangles, as BAMG writes it
constexpr std::string_view kBamg =
    "MeshVersionFormatted 0\nDimension 2\nIdentifier\n\"G=x.mesh\"\nGeometry\n\"x.mesh\"\n"
    "Vertices\n4\n0 0 1\n1 0 2\n1 1 3\n0 1 4\n"
    "hVertices\n0.5 1 1.5 2\n"
    "Edges\n4\n1 2 1\n2 3 2\n3 4 3\n4 1 4\n"
    "Triangles\n2\n1 2 3 7\n1 3 4 8\n"
    "SubDomainFromMesh\n3\n3 2 1 8\n3 1 1 7\n3 2 -1 9\n"
    "SubDomainFromGeom 1\n2 9 1 1\n"
    "VertexOnGeometricVertex\n4\n1 1\n2 2\n3 3\n4 4\n"
    "VertexOnGeometricEdge\n3\n2 1 0.25\n3 1 0.5\n2 2 0\n"
    "EdgeOnGeometricEdge\n2\n1 1\n4 2\n"
    "CrackedEdges\n1\n1 3\n"
    "PeriodicVertices\n2\n1 2\n4 3\n"
    "TangentAtEdgeVertices\n2\n2 1 1\n2 2 1\n"
    "VertexOnSupportVertex\n1\n4 9\n"
    "MeshSupportOfVertices\n\"y.mesh\"\n"
    "End\n";

TEST(Medit, NumbersInSectionsOfBamgFollowTheNewOrder) {
  const TemporaryFolder folder;
  test::expect_order_and_back(folder.file("m.mesh", kBamg));
  Notes notes;
  Mesh mesh = read(kBamg, &notes);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_EQ(written(read(written(mesh))), written(mesh));
  apply_reordering(mesh, Permutation::from_old_to_new({3, 1, 0, 2}),
                   Permutation::from_old_to_new({2, 0, 3, 1, 5, 4}));
  const std::string text = written(mesh, &notes);
  EXPECT_THAT(notes, IsEmpty());
  for (const char* const section :
       {"\nVertices\n4\n1 1 3\n1 0 2\n0 1 4\n0 0 1\n", "\nhVertices\n 1.5\n 1\n 2\n 0.5\n",
        "\nEdges\n4\n2 1 2\n3 4 4\n4 2 1\n1 3 3\n", "\nTriangles\n2\n4 1 3 8\n4 2 1 7\n",
        "\nSubDomainFromMesh\n3\n3 1 1 8\n3 2 1 7\n3 1 -1 9\n", "\nSubDomainFromGeom\n1\n2 9 1 1\n",
        "\nVertexOnGeometricVertex\n4\n4 1\n2 2\n1 3\n3 4\n",
        "\nVertexOnGeometricEdge\n3\n2 1 0.25\n1 1 0.5\n2 2 0\n", "\nEdgeOnGeometricEdge\n2\n3 1\n2 2\n",
        "\nCrackedEdges\n1\n3 4\n", "\nPeriodicVertices\n2\n4 2\n3 1\n",
        "\nTangentAtEdgeVertices\n2\n1 1 1\n1 2 1\n", "\nVertexOnSupportVertex\n1\n3 9\n",
        "\nMeshSupportOfVertices\n\"y.mesh\"\n"}) {
    EXPECT_THAT(text, HasSubstr(section));
  }
}

TEST(Medit, NumbersInAGeometryOfBamgFollowTheNewOrder) {
  const std::string geometry =
      "MeshVersionFormatted 0\nMaximalAngleOfCorner 46\nDimension 2\nVertices\n3\n0 0 1\n1 0 1\n0 1 1\n"
      "Edges\n3\n1 2 1\n2 3 1\n3 1 1\nMetricVertices\n1 0 1\n2 0 2\n3 0 3\n"
      "TangentAtEdges\n1\n2 1 0.5 -0.5\nSubDomain\n1\n2 3 1 0\nEnd\n";
  for (const auto& [name, text] :
       {std::pair{"SubDomain", geometry},
        {"SubDomainFromGeom", replaced(geometry, "SubDomain", "SubDomainFromGeom")}}) {
    const TemporaryFolder folder;
    test::expect_order_and_back(folder.file("m.mesh", text));
    Mesh mesh = read(text);
    apply_reordering(mesh, Permutation::from_old_to_new({1, 2, 0}), Permutation::from_old_to_new({2, 0, 1}));
    const std::string out = written(mesh);
    EXPECT_THAT(out, HasSubstr("\nMaximalAngleOfCorner 46\n"));
    EXPECT_THAT(out, HasSubstr("\nMetricVertices\n 3 0 3\n 1 0 1\n 2 0 2\n"));
    EXPECT_THAT(out, HasSubstr("\nTangentAtEdges\n1\n1 1 0.5 -0.5\n"));
    EXPECT_THAT(out, HasSubstr(std::string("\n") + name + "\n1\n2 2 1 0\n"));
  }
}

TEST(Medit, LeavesOutLinesWithCellsThatAreGone) {
  Mesh mesh = read(kBamg);
  const std::vector<Index> cells{-1, 0, 1, 2, -1, 3};  // without the first edge and triangle
  mesh.format_metadata = mesh.format_metadata->moved({}, cells);
  Cells rest;
  for (const Index c : {1, 2, 3, 5}) rest.push_back(mesh.cells.shapes[c], mesh.cells[c]);
  mesh.cells = rest;
  mesh.cell_blocks.clear();
  std::erase_if(mesh.data, [](const DataArray& array) { return array.association == Association::cells; });
  Notes notes;
  const std::string text = written(mesh, &notes);
  EXPECT_THAT(text, HasSubstr("\nSubDomainFromMesh\n2\n3 1 1 8\n3 1 -1 9\n"));
  EXPECT_THAT(text, HasSubstr("\nCrackedEdges\n0\n"));
  EXPECT_THAT(notes, AllOf(Contains("1 lines of SubDomainFromMesh are left out with their cells"),
                           Contains("1 lines of CrackedEdges are left out with their cells")));
}

TEST(Medit, ReadsSectionsInAnyOrderAndKeywordsInAnyCase) {
  const Mesh mesh = read(
      "MeshVersionFormatted 2 Dimension 2\r\n"
      "RequiredEdges 1\r 2\n"
      "TRIANGLES 1 1 2 3 5\n"
      "RequiredVertices 1 3\n"
      "Edges 2 1 2 1 2 3 1\n"
      "Vertices 3 0 0 0 1.0D0 0 0 0 +1 0\n"
      "END");
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_THAT(mesh.cells.shapes, ElementsAre(Shape::triangle, Shape::line, Shape::line));
  EXPECT_EQ(mesh.points[2], (Point{0, 1, 0}));
  EXPECT_EQ(mesh.sets[0], (EntitySet{"RequiredEdges", Association::cells, {2}}));
  EXPECT_EQ(mesh.sets[1], (EntitySet{"RequiredVertices", Association::vertices, {2}}));
}

TEST(Medit, ReadsOldNamesOfSections) {
  const Mesh mesh = read(
      "MeshVersionFormatted 0\nDimension 3\nVertices 8\n0 0 0 0 1 0 0 0 1 1 0 0 0 1 0 0\n"
      "0 0 1 0 1 0 1 0 1 1 1 0 0 1 1 0\nPentahedra 1\n1 2 3 5 6 7 1\nHexaedra 1\n1 2 3 4 5 6 7 8 2\nEnd\n");
  EXPECT_THAT(mesh.cells.shapes, ElementsAre(Shape::wedge, Shape::hexahedron));
}

TEST(Medit, KeepsReferencesOf64Bits) {
  const Mesh mesh =
      read("MeshVersionFormatted 4\nDimension 2\nVertices 2\n0 0 5000000000\n1 0 0\nEdges 1\n1 2 7\nEnd\n");
  EXPECT_THAT(values<std::int64_t>(mesh, kLabel, Association::vertices), ElementsAre(5000000000, 0));
  test::expect_write_and_read(mesh, "m.mesh");
}

TEST(Medit, KeepsAMemberThatAListNamesTwiceOnce) {
  Notes notes;
  const Mesh mesh = read(
      "MeshVersionFormatted 2\nDimension 2\nVertices 3\n0 0 1\n1 0 2\n0 1 2\n"
      "Triangles 1\n1 2 3 0\nCorners 4\n3 1 3 3\nEnd\n",
      &notes);
  EXPECT_THAT(mesh.sets.at(0).members, ElementsAre(2, 0));
  EXPECT_THAT(notes, ElementsAre("the set 'Corners' names 2 members twice, which are kept once"));
}

TEST(Medit, WritesTheVersionThatHoldsItsReferences) {
  const auto version_of = [](Values labels, Association on) {
    Mesh mesh = test::cells_of_type(Shape::line, 2, 1);
    mesh.data = {{std::string(kLabel), on, 1, std::move(labels), {}, {}}};
    const std::string text = write_mesh_to_memory(mesh, "medit", "m.mesh").files.front().bytes;
    return text.substr(0, text.find('\n'));
  };
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  using Longs = std::vector<std::int64_t>;
  EXPECT_EQ(version_of(Longs{kMost}, Association::cells), "MeshVersionFormatted 2");
  EXPECT_EQ(version_of(Longs{kMost + 1}, Association::cells), "MeshVersionFormatted 4");
  EXPECT_EQ(version_of(Longs{-kMost - 2}, Association::cells), "MeshVersionFormatted 4");
  EXPECT_EQ(version_of(Longs{1, kMost}, Association::vertices), "MeshVersionFormatted 2");
  EXPECT_EQ(version_of(Longs{1, kMost + 1}, Association::vertices), "MeshVersionFormatted 4");
}

TEST(Medit, AcceptsAFileWithoutEndAndSaysSo) {
  Notes notes;
  const std::string_view content =
      "MeshVersionFormatted 2\nDimension 2\nVertices 2\n0 0 1\n1 0 2\nEdges 1\n1 2 34";
  EXPECT_EQ(read(content, &notes).cell_count(), 1);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("has no End"), HasSubstr("has no final newline")));
  notes.clear();
  (void)read(std::string(content) + "\n", &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("has no End")));
}

TEST(Medit, NotesCommentsOfLongSections) {
  std::string text = "# kept\nMeshVersionFormatted 2\nDimension 3\nVertices\n200000\n";
  const std::string begin = text;
  for (int k = 0; k < 200000; ++k) text += "0.25 0.5 0.75 1\n";
  const std::string end = "Tetrahedra\n1\n1 2 3 4 0\nEnd\n# kept, too\n";
  Notes notes;
  (void)read(text + end, &notes);
  EXPECT_THAT(notes, IsEmpty());
  // in a line, and as a line, within and at the ends of the parts that threads read
  for (const std::size_t line : {0, 70000, 199999}) {
    const std::size_t at = begin.size() + 16 * line + 15;
    for (const char* const comment : {" # in a line", "\n# a line", "\n\n  # after a blank line"}) {
      notes.clear();
      (void)read(std::string(text).insert(at, comment) + end, &notes);
      EXPECT_THAT(notes, ElementsAre(HasSubstr("comments between the data are left out"))) << line << comment;
    }
  }
}

TEST(Medit, NotesSolutionsBesideTheMesh) {
  const TemporaryFolder folder;
  const fs::path path = folder.file("m.mesh", kFile);
  (void)folder.file("m.sol", "MeshVersionFormatted 2\n");
  Notes notes;
  const Mesh mesh = read_mesh(path, {.notes = &notes});
  EXPECT_THAT(notes, Contains(AllOf(HasSubstr("m.sol"), HasSubstr("original order"))));
  notes.clear();
  write_mesh(mesh, path, &notes);
  EXPECT_THAT(notes, ElementsAre(AllOf(HasSubstr("m.sol"), HasSubstr("does not fit"))));
}

// ---- second order

constexpr std::string_view kQuadratic =
    "MeshVersionFormatted 2\nDimension 2\n"
    "Vertices\n6\n0 0 0\n2 0 0\n0 2 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Medit, SecondOrderNodesComeInVtksOrderWithoutAnOrdering) {
  const Mesh mesh =
      read(std::string(kQuadratic) + "TrianglesP2\n1\n1 2 3 4 5 6 7\nRequiredTriangles\n1\n1\nEnd\n");
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(mesh.sets[0].members, ElementsAre(0));
  EXPECT_THAT(written(mesh), testing::Not(HasSubstr("Ordering")));
}

TEST(Medit, FollowsTheOrderingThatAFileGives) {
  // lexicographic, as in many high-order codes
  const std::string text = std::string(kQuadratic) +
                           "TrianglesP2\n1\n1 4 2 6 5 3 7\n"
                           "TrianglesP2Ordering\n6\n2 0 0\n1 1 0\n0 2 0\n1 0 1\n0 1 1\n0 0 2\nEnd\n";
  const Mesh mesh = read(text);
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 1, 2, 3, 4, 5));
  const std::string back = written(mesh);
  EXPECT_THAT(back, HasSubstr("\nTrianglesP2\n1\n1 4 2 6 5 3 7\n"));
  EXPECT_THAT(back, HasSubstr("\nTrianglesP2Ordering\n6\n2 0 0\n1 1 0\n0 2 0\n1 0 1\n0 1 1\n0 0 2\n"));
  test::expect_same(read(back), mesh);
}

TEST(Medit, AnOrderingThatMakesNoSenseLeavesNodesAsTheyAre) {
  Notes notes;
  const Mesh mesh = read(std::string(kQuadratic) +
                             "TrianglesP2\n1\n1 4 2 6 5 3 7\n"
                             "TrianglesP2Ordering\n6\n2 0 0\n2 0 0\n0 2 0\n1 0 1\n0 1 1\n0 0 2\nEnd\n",
                         &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("TrianglesP2Ordering is not supported")));
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 3, 1, 5, 4, 2));
  EXPECT_THAT(written(mesh), HasSubstr("\nTrianglesP2\n1\n1 4 2 6 5 3 7\n"));
}

TEST(Medit, ReordersTheNodesOfCellsFromOtherFormats) {
  Mesh mesh = test::cells_of_type(Shape::hexahedron, 27, 1);
  mesh.sets.clear();
  const std::string text = written(mesh);
  // VTK's faces come as x = 0, x = 1, y = 0, y = 1, z = 0, z = 1
  EXPECT_THAT(text,
              HasSubstr("\nHexahedraQ2Ordering\n27\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n"
                        "1 0 0\n2 1 0\n1 2 0\n0 1 0\n1 0 2\n2 1 2\n1 2 2\n0 1 2\n0 0 1\n2 0 1\n2 2 1\n0 2 1\n"
                        "0 1 1\n2 1 1\n1 0 1\n1 2 1\n1 1 0\n1 1 2\n1 1 1\n"));
  Notes notes;
  const std::string without =
      text.substr(0, text.find("\nHexahedraQ2Ordering")) + text.substr(text.find("\nEnd\n"));
  (void)read(without, &notes);
  EXPECT_THAT(notes, ElementsAre(AllOf(HasSubstr("HexahedraQ2"), HasSubstr("VTK's order"))));
}

// ---- meshes of other formats

Mesh with_labels_only(Mesh mesh) {
  std::erase_if(mesh.data, [](const DataArray& array) { return array.name != kLabel; });
  mesh.sets.clear();
  group_cells_by_type(mesh);
  return mesh;
}

TEST(Medit, WritesAndReadsEveryTypeThatItHolds) {
  auto types = test::linear_types();
  std::erase(types, std::pair{Shape::vertex, 1});
  types.insert(types.end(), {{Shape::line, 3},
                             {Shape::triangle, 6},
                             {Shape::quad, 9},
                             {Shape::tetrahedron, 10},
                             {Shape::pyramid, 14},
                             {Shape::wedge, 18},
                             {Shape::hexahedron, 27}});
  for (const auto& [shape, nodes] : types) {
    SCOPED_TRACE(type_name(shape, nodes));
    test::expect_write_and_read(with_labels_only(test::cells_of_type(shape, nodes, 4)), "m.mesh");
  }
}

/// The cells of the mixed mesh that Medit holds, interleaved, with labels.
Mesh interleaved() {
  const Mesh all = test::mixed_mesh();
  Mesh mesh = all;
  mesh.cells = {};
  std::vector<std::int32_t> labels;
  for (Index c = 0; c < all.cell_count(); ++c) {
    const Shape shape = all.cells.shapes[c];
    const int nodes = all.cells.vertex_count(c);
    if (shape == Shape::vertex || nodes == 20 || nodes == 15 || nodes == 13 ||
        (shape == Shape::quad && nodes == 8))
      continue;
    mesh.cells.push_back(shape, all.cells[c]);
    labels.push_back(c);
  }
  std::erase_if(mesh.data, [](const DataArray& array) {
    return array.association == Association::cells || array.name != kLabel;
  });
  mesh.data.push_back({std::string(kLabel), Association::cells, 1, labels, {}, {}});
  mesh.sets.clear();
  return mesh;
}

TEST(Medit, GroupsInterleavedCells) {
  const TemporaryFolder folder;
  const Mesh mesh = interleaved();
  ASSERT_GT(mesh.cell_count(), 30);
  write_mesh(mesh, folder.path() / "m.mesh");
  const Mesh back = read_mesh(folder.path() / "m.mesh");
  Mesh expected = mesh;
  group_cells_by_type(expected);
  test::expect_same(back, expected);
  test::expect_order_and_back(folder.path() / "m.mesh");
}

TEST(Medit, KeepsSetsThatItKnowsAndNamesWhatIsLost) {
  Mesh mesh = test::tetrahedral_bar(2);
  mesh.sets.push_back({"RequiredVertices", Association::vertices, {3, 1}});
  mesh.sets.push_back({"RequiredTriangles", Association::cells, {0}});  // cell 0 is a tetrahedron
  mesh.cell_ids.resize(mesh.cell_count(), 0);
  mesh.data.push_back({"NormalAtVertices", Association::vertices, 1, std::vector<double>{1}, {0}, {}});
  mesh.data.push_back({"names", Association::cells, 1, std::vector<std::string>(mesh.cell_count()), {}, {}});
  Notes notes;
  const std::string text = written(mesh, &notes);
  EXPECT_THAT(text, HasSubstr("\nRequiredVertices\n2\n4\n2\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("RequiredTriangles")));
  EXPECT_THAT(notes, testing::UnorderedElementsAre(
                         HasSubstr("'fixed'"), HasSubstr("'part'"), HasSubstr("'RequiredTriangles'"),
                         HasSubstr("'temperature' on vertices"), HasSubstr("'stress' on vertices"),
                         HasSubstr("'temperature' on cells"), HasSubstr("'stress' on cells"),
                         HasSubstr("'NormalAtVertices'"), HasSubstr("'names'"), HasSubstr("ids of cells")));
}

TEST(Medit, CellsWithoutALabelGetZero) {
  Mesh mesh = test::cells_of_type(Shape::tetrahedron, 4, 2);
  mesh.sets.clear();
  mesh.data = {{std::string(kLabel), Association::cells, 1, std::vector<std::int32_t>{8}, {1}, {}}};
  Notes notes;
  EXPECT_THAT(written(mesh, &notes), HasSubstr("\nTetrahedra\n2\n1 2 3 4 0\n5 6 7 8 8\n"));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("1 cells have no label")));
}

TEST(Medit, ReportsWhatOtherFormatsLose) {
  const TemporaryFolder folder;
  Mesh mesh = read(
      "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0\n"
      "Tetrahedra 1\n1 2 3 4 5\nBoundingBox 0 0 0 1 1 1\nEnd\n");
  Notes notes;
  write_mesh(mesh, folder.path() / "m.node", &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("Medit's BoundingBox")));
}

TEST(Medit, RefusesCellsThatItCannotHold) {
  const TemporaryFolder folder;
  for (const auto& [shape, nodes] :
       {std::pair{Shape::hexahedron, 20}, {Shape::quad, 8}, {Shape::vertex, 1}, {Shape::polygon, 5}}) {
    try {
      write_mesh(test::cells_of_type(shape, nodes, 1), folder.path() / "m.mesh");
      ADD_FAILURE() << type_name(shape, nodes);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr(type_name(shape, nodes)), HasSubstr("; write .")));
    }
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Medit, SaysWhereItCannotWrite) {
  const TemporaryFolder folder;
  const Mesh mesh = read(kFile);
  EXPECT_THROW(write_mesh(mesh, folder.path() / "none" / "m.mesh"), InputError);
  fs::create_directory(folder.path() / "m.mesh");
  EXPECT_THROW(write_mesh(mesh, folder.path() / "m.mesh"), InputError);
  EXPECT_THAT(folder.names(), ElementsAre("m.mesh"));
}

// ---- broken files

TEST(Medit, SaysWhatIsWrongAndWhere) {
  const std::string head = "MeshVersionFormatted 2\nDimension 3\n";
  const std::string vertices = head + "Vertices\n4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n";  // 8 lines
  const std::string cell = "Tetrahedra\n1\n1 2 3 4 5\n";
  test::expect_broken(
      "m.mesh",
      {{"empty", "", "is empty"},
       {"comments", "# nothing\n", ":2: is not a Medit mesh"},
       {"MFEM", "MFEM mesh v1.0\n\ndimension\n2\n", ":1: is not a Medit mesh"},
       {"binary", std::string("\1\0\0\0\2\0\0\0\3\0\0\0", 12), "is binary"},
       {"garbage", "\xff\xfe\x80zzz", ":1: is not a Medit mesh"},
       {"garbage within", head + "\x80\xff", "expected a keyword, found"},
       {"no version", "MeshVersionFormatted", "unexpected end of file; expected the version"},
       {"unknown version", "MeshVersionFormatted 9\n", ":1: the version is 9"},
       {"no dimension", "MeshVersionFormatted 2\nVertices 0\n",
        ":2: the section Vertices comes before the Dimension"},
       {"dimension 4", "MeshVersionFormatted 2\nDimension 4\n", ":2: the dimension is 4"},
       {"only a head", head, "has no Vertices"},
       {"no vertices", head + "End\n", "has no Vertices"},
       {"no cells", vertices + "End\n", "has no cells"},
       {"no cells but their section", vertices + "Tetrahedra 0\nEnd\n", "has no cells"},
       {"absurd vertices", head + "Vertices\n1000000000000\n0 0 0 1\n",
        ":4: the count of Vertices is 1000000000000"},
       {"large vertices", head + "Vertices\n2000000000\n0 0 0 1\n", "bytes follow"},
       {"negative vertices", head + "Vertices\n-3\n", ":4: the count of Vertices is -3"},
       {"one vertex too many", replaced(vertices, "4\n", "3\n") + cell, ":8: expected a keyword, found '0'"},
       {"one vertex too few", replaced(vertices, "4\n", "5\n") + cell, ":9: a coordinate is 'Tetrahedra'"},
       {"nan", replaced(vertices, "0 1 0", "0 nan 0") + cell, ":7: a coordinate is not finite"},
       {"infinite", replaced(vertices, "0 1 0", "0 inf 0") + cell, ":7: a coordinate is not finite"},
       {"huge", replaced(vertices, "0 1 0", "0 1e400 0") + cell, ":7: a coordinate is 1e400"},
       {"reference missing", replaced(vertices, "0 1 0 1", "0 1 0 x") + cell,
        ":7: the reference of a vertex is 'x'"},
       {"vertex 0", vertices + "Tetrahedra\n1\n0 2 3 4 5\nEnd\n", ":11: a vertex of the cell is 0; 1 to 4"},
       {"vertex beyond", vertices + "Tetrahedra\n1\n1 2 3 5 5\nEnd\n", ":11: a vertex of the cell is 5"},
       {"negative vertex", vertices + "Tetrahedra\n1\n1 2 -3 4 5\nEnd\n", ":11: a vertex of the cell is -3"},
       {"absurd cells", vertices + "Tetrahedra\n1000000000000\n1 2 3 4 5\nEnd\n",
        ":10: the count of Tetrahedra is 1"},
       {"negative cells", vertices + "Tetrahedra\n-1\nEnd\n", ":10: the count of Tetrahedra is -1"},
       {"cells without vertices", head + cell + "End\n", "has no Vertices"},
       {"cells twice", vertices + cell + cell + "End\n", ":12: a second section Tetrahedra"},
       {"vertices twice", vertices + "Vertices\n1\n0 0 0 0\n" + cell, ":9: a second section Vertices"},
       {"list beyond", vertices + cell + "Corners\n1\n5\nEnd\n", ":14: a number of Corners is 5"},
       {"list of what is not there", vertices + cell + "Ridges\n1\n1\nEnd\n",
        "Ridges counts cells of type line"},
       {"absurd list", vertices + cell + "Corners\n1000000000000\n5\nEnd\n",
        ":13: the count of Corners is 1"},
       {"table beyond", vertices + cell + "NormalAtVertices\n1\n9 1\nEnd\n",
        ":14: a number of NormalAtVertices is 9"},
       {"short normals", vertices + cell + "Normals\n2\n0 0 1\n1 0\nEnd\n",
        ":16: a number of Normals is 'End'"},
       {"ordering of another size", vertices + cell + "TetrahedraP2Ordering\n4\n2 0 0 0\n", "10 are needed"},
       {"domain without triangles", vertices + cell + "SubDomainFromMesh\n1\n3 1 1 0\nEnd\n",
        ":14: a line of SubDomainFromMesh begins with '3'; it must begin with 2, for an edge"},
       {"domain of tetrahedra", vertices + "Triangles\n1\n1 2 3 1\nSubDomainFromMesh\n1\n4 1 1 0\nEnd\n",
        ":14: a line of SubDomainFromMesh begins with '4'; it must begin with 3, for a triangle"},
       {"edge of a domain", vertices + cell + "SubDomain\n1\n2 1 1 0\nEnd\n",
        ":14: SubDomain counts cells of type line, and there are none"},
       {"periodic vertex beyond", vertices + cell + "PeriodicVertices\n1\n1 5\nEnd\n",
        ":14: a number of PeriodicVertices is 5; 1 to 4"},
       {"sizes first", head + "hVertices\n1 1 1 1\nVertices 0\n", ":3: hVertices comes before Vertices"},
       {"too few sizes", vertices + "hVertices\n1 1 1\n" + cell,
        ":11: a number of hVertices is 'Tetrahedra'"},
       {"unknown section", vertices + cell + "Fault_SmallTri\n1\n1\nEnd\n",
        ":12: the section Fault_SmallTri is not supported"},
       {"section of cubic cells", vertices + "TetrahedraP3\n0\nEnd\n",
        "the section TetrahedraP3 is not supported"}});
}

TEST(Medit, RefusesFoldersAndMissingFiles) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "m.mesh");
  EXPECT_THAT(test::read_error(folder.path() / "m.mesh"), HasSubstr("is a folder"));
  EXPECT_THAT(test::read_error(folder.path() / "none.mesh"), HasSubstr("no such file"));
}

TEST(Medit, NoticesTruncation) {
  test::expect_truncation_is_noticed(
      "m.mesh",
      "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 1.5 1\n"
      "Tetrahedra\n2\n1 2 3 4 5\n2 3 4 5 6\nEnd\n");
  // a cut between two sections gives only a note
  const Mesh whole = read(kFile);
  for (std::size_t size = 0; size < kFile.find("End"); ++size) {
    Notes notes;
    try {
      (void)read(kFile.substr(0, size), &notes);
      EXPECT_FALSE(notes.empty()) << "cut after " << size;
    } catch (const InputError&) {
      continue;
    }
  }
}

}  // namespace
}  // namespace meshorder
