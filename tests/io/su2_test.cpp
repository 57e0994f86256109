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

namespace meshorder {
namespace {

using test::TemporaryFolder;
using test::with;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// a square of two triangles and a quadrilateral above it
constexpr std::string_view kPlane =
    "% made by hand\n"
    "NDIME= 2\n"
    "NELEM= 3\n"
    "5 0 1 3 0\n"
    "5 1 2 3 1\n"
    "9 3 2 5 4 2\n"
    "NPOIN= 6\n"
    "0 0 0\n"
    "1 0 1\n"
    "1 1 2\n"
    "0 1 3\n"
    "0 2.5 4\n"
    "1 2.5 5\n"
    "% the boundary\n"
    "NMARK= 3\n"
    "MARKER_TAG= lower\n"
    "MARKER_ELEMS= 1\n"
    "3 0 1\n"
    "MARKER_TAG= empty\n"
    "MARKER_ELEMS= 0\n"
    "MARKER_TAG= sides\n"
    "MARKER_ELEMS= 2\n"
    "3 1 2\n"
    "3 2 5\n"
    "NPERIODIC= 1\n"
    "PERIODIC_INDEX= 0\n"
    "PERIODIC_CENTER= 0 0 0\n";

// a hexahedron, a pyramid on it, a tetrahedron and a wedge beside it, whose first triangle faces outward
constexpr std::string_view kVolumes =
    "ndime = 3\n"
    "Nelem =4\n"
    "12 0 1 2 3 4 5 6 7\n"
    "14 4 5 6 7 8\n"
    "10 1 9 2 5   % a comment\n"
    "13 1 9 2 10 12 11\n"
    "NPOIN=13 13\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n.5 .5 2\n"
    "2 0 0\n1 0 -1\n1 1 -1\n2 0 -1\n"
    "NMARK= 2\n"
    "MARKER_TAG= 7\n"
    "MARKER_ELEMS= 2\n"
    "9 0 1 2 3\n"
    "5 4 5 8\n"
    "MARKER_TAG= -2\n"
    "MARKER_ELEMS= 1\n"
    "5 5 6 8\n";

Mesh read_su2(std::string_view content, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  return read_mesh(folder.file("m.su2", content), {.notes = notes});
}

std::string su2_of(const Mesh& mesh, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "m.su2", notes);
  return test::content_of(folder.path() / "m.su2");
}

TEST(Su2, ReadsElementsPointsAndMarkers) {
  Notes notes;
  const Mesh mesh = read_su2(kPlane, &notes);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.points[4], (Point{0, 2.5, 0}));
  EXPECT_THAT(mesh.cells.shapes, ElementsAre(Shape::triangle, Shape::triangle, Shape::quad, Shape::line,
                                             Shape::line, Shape::line));
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 1, 3, 1, 2, 3, 3, 2, 5, 4, 0, 1, 1, 2, 2, 5));
  EXPECT_THAT(mesh.cell_blocks, ElementsAre(0, 3, 4));
  ASSERT_EQ(mesh.sets.size(), 3U);
  EXPECT_EQ(mesh.sets[0], (EntitySet{"lower", Association::cells, {3}}));
  EXPECT_EQ(mesh.sets[1], (EntitySet{"empty", Association::cells, {}}));
  EXPECT_EQ(mesh.sets[2], (EntitySet{"sides", Association::cells, {4, 5}}));
  EXPECT_THAT(mesh.data, IsEmpty());
  EXPECT_TRUE(mesh.vertex_ids.empty() && mesh.cell_ids.empty());
}

TEST(Su2, NamesThatAreNumbersAreLabels) {
  const Mesh mesh = read_su2(kVolumes);
  EXPECT_THAT(mesh.sets, IsEmpty());
  const DataArray* const labels = find_array(mesh, kLabel, Association::cells);
  ASSERT_NE(labels, nullptr);
  EXPECT_THAT(std::get<std::vector<std::int32_t>>(labels->values), ElementsAre(0, 0, 0, 0, 7, 7, -2));
  EXPECT_THAT(read_su2(with(std::string(kVolumes), "TAG= 7", "TAG= 07")).sets,
              ElementsAre(EntitySet{"07", Association::cells, {4, 5}}));
}

TEST(Su2, CommentsOfAMarkerStayInIt) {
  const std::string text =
      with(std::string(kPlane), "MARKER_TAG= sides\n", "MARKER_TAG= sides\n% inlet and outlet\n\n");
  EXPECT_EQ(su2_of(read_su2(text)), text);
}

TEST(Su2, KeywordsMayBeInAnyCaseAndOrderWithBlanksAndComments) {
  const Mesh mesh = read_su2(kVolumes);
  EXPECT_THAT(mesh.cells.shapes, ElementsAre(Shape::hexahedron, Shape::pyramid, Shape::tetrahedron,
                                             Shape::wedge, Shape::quad, Shape::triangle, Shape::triangle));
  EXPECT_EQ(mesh.vertex_count(), 13);
  // points first, as meshio writes them
  std::string text(kPlane);
  const std::size_t elements = text.find("NELEM");
  const std::size_t points = text.find("NPOIN");
  const std::size_t boundary = text.find("% the boundary");
  const std::string turned = text.substr(0, elements) + text.substr(points, boundary - points) +
                             text.substr(elements, points - elements) + text.substr(boundary);
  EXPECT_EQ(read_su2(turned).cells, read_su2(kPlane).cells);
  EXPECT_EQ(su2_of(read_su2(turned)), turned);
  std::string windows;
  for (const char c : kPlane) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(su2_of(read_su2(windows)), kPlane);
}

TEST(Su2, TheFirstTriangleOfAWedgeFacesOutwardInTheFile) {
  const Mesh mesh = read_su2(kVolumes);
  EXPECT_THAT(std::vector<Index>(mesh.cells[3].begin(), mesh.cells[3].end()),
              ElementsAre(1, 2, 9, 10, 11, 12));
  EXPECT_THAT(su2_of(mesh), HasSubstr("\n13 1 9 2 10 12 11\n"));
  // as Gmsh writes it
  const Mesh inward = read_su2(with(std::string(kVolumes), "13 1 9 2 10 12 11", "13 1 2 9 10 11 12"));
  EXPECT_EQ(inward.cells, mesh.cells);
  EXPECT_THAT(su2_of(inward), HasSubstr("\n13 1 2 9 10 11 12\n"));
  Mesh fresh = mesh;
  fresh.format.clear();
  fresh.format_metadata.reset();
  EXPECT_THAT(su2_of(fresh), HasSubstr("\n13 1 9 2 10 12 11\n"));
}

TEST(Su2, WritesTheSameFileAgain) {
  EXPECT_EQ(su2_of(read_su2(kPlane)), kPlane);
  const std::string volumes = su2_of(read_su2(kVolumes));
  EXPECT_THAT(volumes, HasSubstr("NPOIN= 13 13\n"));
  EXPECT_EQ(su2_of(read_su2(volumes)), volumes);
  test::expect_order_and_back_to("m.su2", kPlane);
  test::expect_order_and_back_to("m.su2", volumes);
}

TEST(Su2, KeepsLinesThatNameNoPoint) {
  Notes notes;
  const std::string boxes = std::string(kPlane) +
                            "FFD_NBOX= 1\nFFD_TAG= wing\nFFD_CORNER_POINTS= 2\n0 0\n1 1\n"
                            "FFD_CONTROL_POINTS= 0\nFFD_SURFACE_POINTS= 0\nNOVEL= 3\n";
  const Mesh mesh = read_su2(boxes, &notes);
  EXPECT_THAT(notes, ElementsAre("NOVEL= is not known, and its line is kept as it is"));
  EXPECT_EQ(su2_of(mesh), boxes);
  EXPECT_THAT(mesh.format_metadata->contents(), testing::Contains("SU2's FFD_TAG="));
}

TEST(Su2, PointsOfBoxesFollowTheOrder) {
  const std::string boxes =
      std::string(kPlane) + "FFD_SURFACE_POINTS= 2\nlower\t0\t0.5 1e-1\nlower\t1\t1 0\n";
  Mesh mesh = read_su2(boxes);
  EXPECT_EQ(su2_of(mesh), boxes);
  const std::vector<Index> old_to_new{3, 5, 0, 1, 2, 4};
  apply_reordering(mesh, Permutation::from_old_to_new(old_to_new), Permutation::identity(mesh.cell_count()));
  EXPECT_THAT(su2_of(mesh), HasSubstr("FFD_SURFACE_POINTS= 2\nlower\t3\t0.5 1e-1\nlower\t5\t1 0\n"));
}

TEST(Su2, KeepsTheValuesOfPeriodicBoundaries) {
  const std::string periodic = with(std::string(kPlane), "PERIODIC_CENTER= 0 0 0\n", "0 0 0\n1 0 0\n0 2 0\n");
  EXPECT_EQ(su2_of(read_su2(periodic)), periodic);
}

TEST(Su2, LeavesOutWhatFollowsCoordinates) {
  Notes notes;
  const Mesh mesh = read_su2(with(std::string(kPlane), "0 2.5 4", "0 2.5 0.1 4"), &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("points have more numbers than coordinates")));
  EXPECT_EQ(mesh.points[4], (Point{0, 2.5, 0}));
}

TEST(Su2, AMarkerThatIsRenamedKeepsItsPlace) {
  const std::string file = with(std::string(kPlane), "TAG= lower", "TAG= a=lower");
  EXPECT_EQ(su2_of(read_su2(file)), with(file, "TAG= a=lower", "TAG= a_lower"));
}

TEST(Su2, NotesNumbersThatAreNotPlaces) {
  Notes notes;
  (void)read_su2(with(std::string(kPlane), "1 1 2\n", "1 1 3\n"), &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("they are ignored, as in SU2")));
}

/// Boundary cells first and last, in sets and with labels, as Gmsh's readers make them.
Mesh foreign() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  const auto add = [&](Shape shape, std::vector<Index> cell) { mesh.cells.push_back(shape, cell); };
  add(Shape::triangle, {0, 1, 2});
  add(Shape::tetrahedron, {0, 1, 2, 3});
  add(Shape::triangle, {0, 1, 3});
  add(Shape::triangle, {1, 2, 4});
  add(Shape::tetrahedron, {1, 2, 3, 4});
  add(Shape::triangle, {2, 3, 4});
  mesh.data.push_back(
      {std::string(kLabel), Association::cells, 1, std::vector<std::int32_t>{0, 0, 9, 0, 0, 0}, {}, {}});
  mesh.sets.push_back({"far field", Association::cells, {3, 0}});
  mesh.format = "gmsh";
  return mesh;
}

TEST(Su2, SetsAndLabelsOfBoundaryCellsBecomeMarkers) {
  Notes notes;
  const std::string text = su2_of(foreign(), &notes);
  EXPECT_THAT(text, HasSubstr("NELEM= 2\n10 0 1 2 3\n10 1 2 3 4\nNPOIN= 5\n0 0 0\n"));
  EXPECT_THAT(text, testing::EndsWith("NMARK= 3\n"
                                      "MARKER_TAG= far field\nMARKER_ELEMS= 2\n5 0 1 2\n5 1 2 4\n"
                                      "MARKER_TAG= 9\nMARKER_ELEMS= 1\n5 0 1 3\n"
                                      "MARKER_TAG= unmarked\nMARKER_ELEMS= 1\n5 2 3 4\n"));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("'far field' has a blank"), HasSubstr("1 boundary elements")));
}

TEST(Su2, ReorderingForItDescribesTheFile) {
  const Mesh mesh = foreign();
  const TemporaryFolder folder;
  const auto path = folder.path() / "m.su2";
  const Permutation places = write_mesh(mesh, path);
  EXPECT_THAT(places.old_to_new(), ElementsAre(2, 0, 4, 3, 1, 5));
  const Mesh back = read_mesh(path);
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto found = back.cells[places.old_to_new()[c]];
    EXPECT_TRUE(std::equal(found.begin(), found.end(), mesh.cells[c].begin(), mesh.cells[c].end())) << c;
  }
  Mesh ordered = mesh;
  const MeshOrder order = reorder(ordered, {.methods = {"rcm", "hilbert"}, .format = "su2"});
  EXPECT_TRUE(write_mesh(ordered, path).is_identity());
  const Mesh again = read_mesh(path);
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto found = again.cells[order.cells.permutation.old_to_new()[c]];
    std::vector<Index> expected;
    for (const Index v : mesh.cells[c]) expected.push_back(order.vertices.permutation.old_to_new()[v]);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end())) << c;
  }
}

TEST(Su2, NotesWhatItCannotHold) {
  Mesh mesh = foreign();
  mesh.sets.push_back({"inside", Association::cells, {1}});
  mesh.sets.push_back({"mixed", Association::cells, {0, 1, 5}});
  mesh.sets.push_back({"pinned", Association::vertices, {4}});
  std::get<std::vector<std::int32_t>>(mesh.data[0].values)[1] = 3;
  mesh.data.push_back({"t", Association::vertices, 1, std::vector<double>(5, 1.5), {}, {}});
  mesh.vertex_ids = {10, 20, 30, 40, 50};
  Notes notes;
  const std::string text = su2_of(mesh, &notes);
  EXPECT_THAT(text, HasSubstr("MARKER_TAG= mixed\nMARKER_ELEMS= 1\n5 2 3 4\n"));
  EXPECT_THAT(notes, testing::UnorderedElementsAre(
                         HasSubstr("has a blank"), HasSubstr("set 'inside' of cells is not written"),
                         HasSubstr("'mixed' is written without 1 cells of the set that are not on"),
                         HasSubstr("'mixed' is written without 1 cells that another marker has"),
                         HasSubstr("set 'pinned' of vertices is not written"),
                         HasSubstr("array 'label' on cells is not written"),
                         HasSubstr("array 't' on vertices is not written"),
                         HasSubstr("ids of vertices are not written")));
}

TEST(Su2, PlaneMeshesLoseTheirThirdCoordinate) {
  Mesh mesh;
  mesh.points = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 1, 2});
  Notes notes;
  EXPECT_THAT(su2_of(mesh, &notes),
              HasSubstr("NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0 0\n1 0\n0 1\nNMARK= 0\n"));
  EXPECT_THAT(notes, ElementsAre("the third coordinate, 2, of all points is not written"));
  mesh.points[1][2] = 1;
  const TemporaryFolder folder;
  EXPECT_THAT(test::write_error(mesh, folder.path() / "m.su2"), HasSubstr("a surface in space"));
}

TEST(Su2, RefusesCellsThatItCannotHold) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "m.su2";
  EXPECT_THAT(test::write_error(test::cells_of_type(Shape::tetrahedron, 10, 1), path),
              HasSubstr("SU2 cannot hold a cell of type tetrahedron10"));
  EXPECT_THAT(test::write_error(test::cells_of_type(Shape::line, 2, 1), path),
              HasSubstr("SU2 cannot hold a cell of type line"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Su2, LeavesOutWhatIsNoElementAndNoBoundary) {
  const TemporaryFolder folder;
  Mesh mesh = foreign();
  mesh.data.clear();
  const Index before = mesh.cell_count();
  mesh.cells.push_back(Shape::line, std::array<Index, 2>{0, 1});
  Notes notes;
  write_mesh(mesh, folder.path() / "m.su2", &notes);
  EXPECT_THAT(notes, Contains(HasSubstr("1 line is left out: SU2 cannot hold it")));
  EXPECT_EQ(read_mesh(folder.path() / "m.su2").cell_count(), before);
}

TEST(Su2, RefusesBrokenFiles) {
  const std::string file(kPlane);
  test::expect_broken(
      "m.su2",
      {
          {"no keyword", "hello\n", ":1: expected a keyword"},
          {"dimension", with(file, "NDIME= 2", "NDIME= 4"), ":2: NDIME= 4"},
          {"no dimension", with(file, "NDIME= 2\n", ""), ":2: NELEM= comes before NDIME="},
          {"no number", with(file, "NELEM= 3", "NELEM= x"), ":3: the number after NELEM= is 'x'"},
          {"nothing", with(file, "NELEM= 3", "NELEM="), ":3: the number after NELEM= is ''"},
          {"negative", with(file, "NELEM= 3", "NELEM= -3"), ":3: NELEM= is -3"},
          {"huge", with(file, "NELEM= 3", "NELEM= 2000000000"), ":3: NELEM= is 2000000000, but only"},
          {"too large", with(file, "NPOIN= 6", "NPOIN= 60000000000"), ":7: NPOIN= is 60000000000"},
          {"too many", with(file, "NELEM= 3", "NELEM= 4"), ":7: NELEM= promises more lines"},
          {"too few", with(file, "NELEM= 3", "NELEM= 2"), ":6: expected a keyword with '='"},
          {"too many points", with(file, "NPOIN= 6", "NPOIN= 7"), ":15: NPOIN= promises more lines"},
          {"type", with(file, "5 1 2 3 1", "6 1 2 3 1"), ":5: an element of type 6 in NELEM="},
          {"a volume", with(file, "9 3 2 5 4 2", "10 3 2 5 4 2"), ":6: an element of type 10"},
          {"a line inside", with(file, "9 3 2 5 4 2", "3 3 2"), ":6: an element of type 3"},
          {"a triangle as marker", with(file, "3 0 1\n", "5 0 1 2\n"),
           ":18: an element of type 5 in MARKER_ELEMS="},
          {"no node", with(file, "5 1 2 3 1", "5 1 2"), ":5: the line ends before a node"},
          {"two numbers more", with(file, "5 1 2 3 1", "5 1 2 3 1 1"),
           ":5: an element of type 5 (triangle) has 3 nodes, but 5 numbers follow the type; the type may be "
           "wrong: 9 is a "
           "quad of 4 nodes"},
          {"far too many numbers", with(file, "5 1 2 3 1", "5 1 2 3 1 1 1 1"),
           "has 3 nodes, but 7 numbers follow the type; after the nodes one number may follow"},
          {"node", with(file, "9 3 2 5 4 2", "9 3 2 6 4 2"), ":6: a node of the element is 6; 0 to 5"},
          {"negative node", with(file, "5 1 2 3 1", "5 1 -2 3 1"), ":5: a node of the element is -2"},
          {"node of a marker", with(file, "3 2 5\n", "3 2 6\n"), ":24: a node of the element is 6; 0 to 5"},
          {"NaN", with(file, "0 2.5 4", "nan 2.5 4"), ":12: a coordinate is not finite"},
          {"infinite", with(file, "0 2.5 4", "0 inf 4"), ":12: a coordinate is not finite"},
          {"no coordinate", with(file, "0 2.5 4", "0"), ":12: the line ends before a coordinate"},
          {"a word behind a point", with(file, "0 2.5 4", "0 2.5 4 a"), ":12: a number after the coord"},
          {"halo points", with(file, "NPOIN= 6", "NPOIN= 6 5"), ":7: only 5 of the 6 points"},
          {"markers", with(file, "NMARK= 3", "NMARK= 4"), "NMARK= 4, but 3 markers follow"},
          {"no count of a marker", with(file, "MARKER_ELEMS= 0\n", ""),
           ":20: the marker empty has no MARKER_ELEMS="},
          {"no name", with(file, "TAG= lower", "TAG="), ":16: MARKER_TAG= has no name"},
          {"twice", with(file, "TAG= sides", "TAG= lower"), ":21: a second marker lower"},
          {"part", with(file, "TAG= sides", "TAG= SEND_RECEIVE"), ":21: the marker SEND_RECEIVE"},
          {"zones", "NZONE= 2\n" + file, ":1: the file has 2 zones"},
          {"surface point", file + "FFD_SURFACE_POINTS= 1\nlower 6 0 0 0\n",
           ":29: a point of FFD_SURFACE_POINTS= is 6; 0 to 5"},
          {"no surface point", file + "FFD_SURFACE_POINTS= 1\nlower\n",
           ":29: a point of FFD_SURFACE_POINTS="},
          {"too many surface points", file + "FFD_SURFACE_POINTS= 2\nlower 0 0 0 0\nA= 1\n",
           ":30: FFD_SURFACE_POINTS= promises more lines"},
          {"surface points first", "NDIME= 2\nFFD_SURFACE_POINTS= 0\n",
           ":2: FFD_SURFACE_POINTS= comes before"},
          {"unknown lines", file + "NOVEL= 1\n3 4\n", ":29: expected a keyword"},
          {"two of them", file + "NPOIN= 0\n", ":28: a second NPOIN="},
          {"no points", "NDIME= 2\nNELEM= 1\n5 0 1 2\n", "has no NPOIN="},
          {"no elements", "NDIME= 2\nNPOIN= 1\n0 0\n", "has no NELEM="},
          {"none", "NDIME= 2\nNELEM= 0\nNPOIN= 1\n0 0\n", "has no cells"},
          {"empty", "", "is empty"},
      });
}

TEST(Su2, ACutFileIsRefusedOrNoted) {
  for (const std::string_view file : {kPlane, kVolumes}) {
    const Mesh whole = read_su2(file);
    for (std::size_t size = 0; size < file.size(); ++size) {
      Notes notes;
      try {
        const Mesh part = read_su2(file.substr(0, size), &notes);
        const bool same = part.cells == whole.cells && part.points == whole.points;
        EXPECT_TRUE(same || !notes.empty()) << "cut after " << size << " bytes";
      } catch (const InputError&) {
        continue;
      }
    }
  }
}

TEST(Su2, IsKnownByItsBytes) {
  EXPECT_EQ(format_of_bytes(kPlane)->name, "SU2");
  EXPECT_EQ(format_of_bytes(kVolumes)->name, "SU2");
  EXPECT_EQ(format_of_bytes("NZONE=1\n")->name, "SU2");
  EXPECT_EQ(format_of_bytes("NDIME 2\n"), nullptr);
}

}  // namespace
}  // namespace meshorder
