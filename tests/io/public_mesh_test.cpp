// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// Tetrahedra and triangles in turn, with ids that are not sorted.
Mesh boundary_in_turn() {
  Mesh mesh = test::tetrahedral_bar(8);
  mesh.data.clear();
  mesh.sets.clear();
  mesh.cell_blocks.clear();
  Mesh result;
  result.points = mesh.points;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    result.cells.push_back(Shape::tetrahedron, mesh.cells[c]);
    if (c % 3 == 0) result.cells.push_back(Shape::triangle, mesh.cells[c].subspan(0, 3));
  }
  for (Index v = 0; v < result.vertex_count(); ++v) result.vertex_ids.push_back(1000 - v);
  for (Index c = 0; c < result.cell_count(); ++c) result.cell_ids.push_back(7 * c % 101 + 5);
  return result;
}

std::vector<std::int64_t> original(const Mesh& mesh, Association association) {
  return std::get<std::vector<std::int64_t>>(find_array(mesh, kOriginal, association)->values);
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

TEST(Ids, AreSortedAlongTheNewOrder) {
  Mesh mesh = boundary_in_turn();
  (void)reorder(mesh, {.methods = {"scrambled", "scrambled"}});
  EXPECT_TRUE(std::is_sorted(mesh.vertex_ids.begin(), mesh.vertex_ids.end()));
}

TEST(Ids, StayWithTheirVerticesAndCells) {
  const Mesh before = boundary_in_turn();
  Mesh mesh = before;
  const MeshOrder order = reorder(mesh, {.methods = {"scrambled", "scrambled"}, .ids = Ids::keep});
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_EQ(mesh.vertex_ids[order.vertices.permutation.old_to_new()[v]], before.vertex_ids[v]);
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    EXPECT_EQ(mesh.cell_ids[order.cells.permutation.old_to_new()[c]], before.cell_ids[c]);
  }
}

TEST(Ids, AreAttachedAsArraysOfTheOldOnes) {
  const Mesh before = boundary_in_turn();
  Mesh mesh = before;
  const MeshOrder order = reorder(mesh, {.methods = {"scrambled", "scrambled"}, .ids = Ids::attach});
  EXPECT_TRUE(std::is_sorted(mesh.vertex_ids.begin(), mesh.vertex_ids.end()));
  const std::vector<std::int64_t> vertices = original(mesh, Association::vertices);
  const std::vector<std::int64_t> cells = original(mesh, Association::cells);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_EQ(vertices[v], before.vertex_ids[order.vertices.permutation.new_to_old()[v]]);
  }
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    EXPECT_EQ(cells[c], before.cell_ids[order.cells.permutation.new_to_old()[c]]);
  }
  // attached again, the new ids would hide the first ones
  const Mesh once = mesh;
  const ReorderOptions again{.ids = Ids::attach};
  EXPECT_THROW(reorder(mesh, again), InvalidArgument);
  test::expect_same(mesh, once);
}

TEST(Ids, AreOldPositionsWhereTheMeshHasNone) {
  Mesh mesh = test::tetrahedral_bar(3);
  const MeshOrder order = reorder(mesh, {.methods = {"scrambled", "original"}, .ids = Ids::attach});
  const auto old = order.vertices.permutation.new_to_old();
  EXPECT_EQ(original(mesh, Association::vertices), (std::vector<std::int64_t>(old.begin(), old.end())));
}

TEST(Ids, AreLeftAloneByAnOrderThatMovesNothing) {
  const Mesh before = boundary_in_turn();
  Mesh mesh = before;
  (void)reorder(mesh, {.methods = {"original", "original"}});
  EXPECT_EQ(mesh.vertex_ids, before.vertex_ids);
  EXPECT_EQ(mesh.cell_ids, before.cell_ids);
}

TEST(Reorder, ForAFormatDescribesItsFile) {
  for (const std::string format : {"medit", "tetgen", "vtu", "gmsh"}) {
    SCOPED_TRACE(format);
    const Mesh before = boundary_in_turn();
    Mesh mesh = before;
    const MeshOrder order = reorder(mesh, {.methods = {"rcm", "lexmax"}, .format = format});
    const MemoryFiles written = write_mesh_to_memory(mesh, format, "a.node");
    EXPECT_TRUE(written.cells.is_identity());
    const auto companion = [&](std::string_view name) {
      for (const MemoryFile& file : written.files) {
        if (file.name == name) return file.bytes;
      }
      return std::string();
    };
    const Mesh back = read_mesh(bytes_of(written.files.front().bytes),
                                {.format = format, .name = "a.node", .companion = companion});
    ASSERT_EQ(back.cell_count(), before.cell_count());
    for (Index c = 0; c < before.cell_count(); ++c) {
      const auto found = back.cells[order.cells.permutation.old_to_new()[c]];
      std::vector<Index> expected;
      for (const Index v : before.cells[c]) expected.push_back(order.vertices.permutation.old_to_new()[v]);
      EXPECT_EQ(std::vector<Index>(found.begin(), found.end()), expected) << c;
    }
  }
}

TEST(Reorder, LeavesTheMeshWhenItFails) {
  const Mesh before = boundary_in_turn();
  Mesh mesh = before;
  const ReorderOptions unknown_method{.methods = {"rcm", "nothing"}, .format = "medit"};
  const ReorderOptions unknown_format{.format = "nothing"};
  const ReorderOptions unknown_array{.group_by = "nothing"};
  for (const ReorderOptions* options : {&unknown_method, &unknown_format, &unknown_array}) {
    EXPECT_THROW(reorder(mesh, *options), InvalidArgument);
    test::expect_same(mesh, before);
  }
  mesh.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(reorder(mesh), InvalidArgument);
}

TEST(WriteMesh, SaysWhereTheCellsAreInTheFile) {
  const Mesh mesh = boundary_in_turn();
  std::stringstream stream;
  const Permutation places = write_mesh(mesh, stream, "medit");
  EXPECT_FALSE(places.is_identity());
  const Mesh back = read_mesh(stream);
  EXPECT_EQ(back.format, "medit");
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto found = back.cells[places.old_to_new()[c]];
    EXPECT_TRUE(std::equal(found.begin(), found.end(), mesh.cells[c].begin(), mesh.cells[c].end())) << c;
  }
}

TEST(WriteMesh, ToMemoryGivesTheBytesOfTheFile) {
  const test::TemporaryFolder folder;
  Mesh mesh = test::tetrahedral_bar(4);
  mesh.sets.clear();
  for (const FormatInfo& format : formats()) {
    if (!format.single_file || format.extensions.front() == ".stl" || format.extensions.front() == ".off" ||
        format.extensions.front() == ".obj" || format.extensions.front() == ".ply" ||
        format.extensions.front() == ".mtx" || format.extensions.front() == ".graph") {
      continue;
    }
    SCOPED_TRACE(format.name);
    const auto path = folder.path() / ("a" + format.extensions.front());
    write_mesh(mesh, path);
    const MemoryFiles written = write_mesh_to_memory(mesh, format.name, "a");
    ASSERT_EQ(written.files.size(), 1U);
    EXPECT_EQ(written.files[0].name, "a");
    // files of CGNS hold the time at which they were written; those of MED have unused bytes at the end in
    // memory, which HDF5 removes when it closes a file
    EXPECT_TRUE(format.name == "cgns" || format.name == "med" ||
                written.files[0].bytes == test::content_of(path));
    // the format is found from the bytes
    const Mesh back = read_mesh(bytes_of(written.files[0].bytes));
    EXPECT_EQ(back.format, format.name);
    EXPECT_EQ(back.cells, read_mesh(path).cells);
  }
}

TEST(WriteMesh, ToAStreamRefusesSeveralFiles) {
  std::stringstream stream;
  EXPECT_THROW(write_mesh(test::tetrahedral_bar(1), stream, "tetgen"), InvalidArgument);
  EXPECT_THROW(write_mesh(test::tetrahedral_bar(1), stream, "nothing"), InvalidArgument);
  EXPECT_TRUE(stream.str().empty());
}

TEST(ReadMesh, FromMemoryNamesTheFileInErrors) {
  const std::string broken = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 x\n";
  try {
    (void)read_mesh(bytes_of(broken), {.name = "part.msh"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("part.msh:5"));
  }
  EXPECT_THROW((void)read_mesh(bytes_of("nothing that is known")), InputError);
  EXPECT_THROW((void)read_mesh(std::span<const std::byte>()), InputError);
  EXPECT_THROW((void)read_mesh(bytes_of("OFF\n"), {.format = "nothing"}), InvalidArgument);
}

TEST(ReadMesh, TakesTheBytesOfEveryPrefixOfAFile) {
  const MemoryFiles written = write_mesh_to_memory(test::tetrahedral_bar(1), "medit", "a.mesh");
  const std::string& whole = written.files[0].bytes;
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    try {
      check_mesh(read_mesh(bytes_of(whole.substr(0, size))));
    } catch (const InputError&) {
      continue;
    }
  }
}

TEST(MakeMesh, CopiesAViewOfAnyLayout) {
  const std::vector<float> points{0, 0, 1, 0, 0, 1, 1, 1};
  const std::vector<std::uint32_t> triangles{1, 2, 3, 2, 4, 3};
  const std::vector<std::int64_t> lines{1, 2};
  const std::vector<CellBlock> blocks{{Shape::triangle, 3, triangles}, {Shape::line, 2, lines}};
  const Mesh mesh = make_mesh({.points = PointsView(points, 2), .cells = CellsView::blocks(blocks, 1)});
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.points[3], (Point{1, 1, 0}));
  EXPECT_EQ(mesh.cells.shapes, (std::vector{Shape::triangle, Shape::triangle, Shape::line}));
  EXPECT_EQ(mesh.cells.vertices, (std::vector<Index>{0, 1, 2, 1, 3, 2, 0, 1}));
  EXPECT_EQ(mesh.cell_blocks, (std::vector<Index>{0, 2}));
  const std::vector<std::uint32_t> outside{1, 2, 9};
  EXPECT_THROW((void)make_mesh({.points = PointsView(points, 2),
                                .cells = CellsView::uniform(Shape::triangle, 3, outside, 1)}),
               InvalidArgument);
  // a mesh of the mesh's own view is the same
  const Mesh again = make_mesh(view(mesh));
  EXPECT_EQ(again.cells, mesh.cells);
}

TEST(CheckMesh, NamesTheFirstFault) {
  const auto fault = [](void (*spoil)(Mesh&)) {
    Mesh mesh = test::tetrahedral_bar(2);
    check_mesh(mesh);
    spoil(mesh);
    try {
      check_mesh(mesh);
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(fault([](Mesh& m) { m.cells.offsets.clear(); }), HasSubstr("offsets"));
  EXPECT_THAT(fault([](Mesh& m) { std::swap(m.cells.offsets[2], m.cells.offsets[3]); }),
              HasSubstr("offsets"));
  EXPECT_THAT(fault([](Mesh& m) { m.cells.vertices[5] = -1; }), HasSubstr("a cell names -1"));
  EXPECT_THAT(fault([](Mesh& m) { m.cells.vertices[5] = 99; }), HasSubstr("a cell names 99"));
  EXPECT_THAT(fault([](Mesh& m) { m.cell_blocks = {0, 999}; }), HasSubstr("blocks"));
  EXPECT_THAT(fault([](Mesh& m) { m.vertex_ids = {1}; }), HasSubstr("ids"));
  EXPECT_THAT(fault([](Mesh& m) {
                m.data.push_back({.name = "a", .components = 0, .values = std::vector<double>(3)});
              }),
              HasSubstr("array 'a' has 0 components"));
  EXPECT_THAT(fault([](Mesh& m) {
                m.data.push_back(
                    {.name = "a", .components = 2, .values = std::vector<double>(2 * m.points.size() + 1)});
              }),
              HasSubstr("array 'a'"));
}

}  // namespace
}  // namespace meshorder
