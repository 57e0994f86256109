// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/nemesis.hpp"

#include "base/index.hpp"
#include "distributed/files/mesh_parts.hpp"
#include "distributed/files/part_borders.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace meshorder::distributed {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Mesh mesh_of(Shape shape, Index vertices, const std::vector<std::vector<Index>>& cells) {
  Mesh mesh;
  mesh.points.resize(static_cast<std::size_t>(vertices));
  for (Index v = 0; v < vertices; ++v) mesh.points[v] = {1.0 * v, 0.5 * v * v, 0};
  for (const std::vector<Index>& cell : cells) mesh.cells.push_back(shape, cell);
  return mesh;
}

/// Nine vertices, and edges that use all except 3 and 8; parts begin at 0, 2, 4 and 6.
Mesh edges() { return mesh_of(Shape::line, 9, {{0, 1}, {1, 2}, {0, 4}, {5, 6}, {4, 7}}); }
const std::vector<GlobalIndex> kStarts{0, 2, 4, 6, 8};

/// The parts of a mesh that this rank holds completely, by a communicator of one rank.
MeshParts parts_of(const Mesh& mesh, const std::vector<GlobalIndex>& starts) {
  return {Communicator(MPI_COMM_SELF), mesh, ShareNumbers::of_whole(mesh), starts};
}
std::vector<std::vector<BorderFacet>> borders_of(const Mesh& mesh, const MeshParts& parts) {
  return facets_between(Communicator(MPI_COMM_SELF), mesh, ShareNumbers::of_whole(mesh), parts);
}

TEST(MeshParts, HaveACellOnceAndAVertexWhereCellsUseIt) {
  const Mesh mesh = edges();
  const MeshParts parts = parts_of(mesh, kStarts);
  ASSERT_EQ(parts.size(), 4);
  EXPECT_THAT(parts.cells(0), ElementsAre(0));
  EXPECT_THAT(parts.cells(1), ElementsAre(1));
  EXPECT_THAT(parts.cells(2), ElementsAre(2));
  EXPECT_THAT(parts.cells(3), ElementsAre(3, 4));
  EXPECT_EQ(parts.part_with(4), 3);
  EXPECT_THAT(parts.vertices(0), ElementsAre(0, 1));
  EXPECT_THAT(parts.vertices(1), ElementsAre(2, 3, 1));        // 3 is in no cell
  EXPECT_THAT(parts.vertices(2), ElementsAre(4, 0));           // 5 is in cells of the last part only
  EXPECT_THAT(parts.vertices(3), ElementsAre(6, 7, 8, 4, 5));  // 8 is after the last part
  EXPECT_THAT(parts.parts_with(0), ElementsAre(0, 2));
  EXPECT_THAT(parts.parts_with(5), ElementsAre(3));
}

TEST(PartCutter, TakesArraysSetsAndIdsAlong) {
  Mesh mesh = edges();
  mesh.vertex_ids = {10, 11, 12, 13, 14, 15, 16, 17, 18};
  mesh.cell_ids = {20, 21, 22, 23, 24};
  mesh.data = {
      {.name = "u",
       .components = 2,
       .values = std::vector<std::int32_t>{0, 0, 1, 1, 2, 4, 3, 9, 4, 16, 5, 25, 6, 36, 7, 49, 8, 64}},
      {.name = "s",
       .association = Association::cells,
       .values = std::vector<float>{40, 10, 30},
       .indices = {4, 1, 3}},
      {.name = "texts", .values = std::vector<std::string>{"a", "b"}, .indices = {1, 7}}};
  mesh.sets = {{"some", Association::vertices, {7, 4, 1}}, {"one", Association::cells, {4}}};
  const MeshParts parts = parts_of(mesh, kStarts);
  PartCutter cutter(mesh, parts);
  const Mesh last = cutter.cut(3);
  check_mesh(last);
  EXPECT_THAT(last.cells.vertices, ElementsAre(4, 0, 3, 1));
  EXPECT_THAT(last.vertex_ids, ElementsAre(16, 17, 18, 14, 15));
  EXPECT_THAT(last.cell_ids, ElementsAre(23, 24));
  EXPECT_EQ(last.points[3], mesh.points[4]);
  EXPECT_EQ(find_array(last, "u", Association::vertices)->values,
            Values(std::vector<std::int32_t>{6, 36, 7, 49, 8, 64, 4, 16, 5, 25}));
  EXPECT_EQ(find_array(last, "s", Association::cells)->values, Values(std::vector<float>{40, 30}));
  EXPECT_THAT(find_array(last, "s", Association::cells)->indices, ElementsAre(1, 0));
  EXPECT_THAT(find_array(last, "texts", Association::vertices)->indices, ElementsAre(1));
  EXPECT_THAT(last.sets[0].members, ElementsAre(1, 3));
  EXPECT_THAT(last.sets[1].members, ElementsAre(1));

  const Mesh first = cutter.cut(0);
  check_mesh(first);
  EXPECT_EQ(find_array(first, "s", Association::cells), nullptr);
  EXPECT_THAT(first.sets[0].members, ElementsAre(1));
  EXPECT_THAT(first.sets[1].members, IsEmpty());
}

TEST(FacetsBetween, ArePairedInOneOrder) {
  // three triangles at the edge 0–1, two of them in one part, and one triangle elsewhere
  const Mesh mesh = mesh_of(Shape::triangle, 6, {{1, 0, 4}, {0, 1, 2}, {5, 0, 1}, {2, 1, 3}});
  const MeshParts parts = parts_of(mesh, {0, 4, 6});
  const auto borders = borders_of(mesh, parts);
  EXPECT_THAT(borders[0], ElementsAre(BorderFacet{1, 1, 0}, BorderFacet{1, 1, 0}));
  EXPECT_THAT(borders[1], ElementsAre(BorderFacet{0, 0, 0}, BorderFacet{0, 2, 1}));
}

TEST(FacetsBetween, AreNotEndsOfLines) {
  const Mesh mesh = edges();
  for (const auto& of_part : borders_of(mesh, parts_of(mesh, kStarts))) EXPECT_THAT(of_part, IsEmpty());
}

TEST(NemesisName, HasAsManyDigitsAsThereAreInTheNumberOfParts) {
  EXPECT_EQ(nemesis_name("out/mesh.e", 16, 3), "out/mesh.e.16.03");
  EXPECT_EQ(nemesis_name("mesh.exo", 9, 8), "mesh.exo.9.8");
  EXPECT_EQ(nemesis_name("mesh.g", 100, 0), "mesh.g.100.000");
}

#ifdef MESHORDER_HAS_NETCDF
TEST(NemesisPieces, HaveAllCellsOfEveryShapeOnce) {
  const Mesh mesh = test::mixed_mesh();
  const std::vector<GlobalIndex> starts{0, mesh.vertex_count() / 3, mesh.vertex_count() / 2,
                                        mesh.vertex_count()};
  const test::TemporaryFolder folder;
  std::vector<std::string> files;
  for (Index part = 0; part < 3; ++part)
    files.push_back((folder.path() / nemesis_name("a.e", 3, part)).string());
  Notes notes;
  const GlobalIndex repeated = write_nemesis_pieces(mesh, starts, files, files, notes);
  std::vector<int> seen(static_cast<std::size_t>(mesh.cell_count()), 0);
  GlobalIndex vertices = 0;
  for (const std::string& file : files) {
    const Mesh piece = read_mesh(file, {.format = "exodus"});
    vertices += piece.vertex_count();
    for (Index c = 0; c < piece.cell_count(); ++c) {
      const auto cell = static_cast<Index>(piece.cell_ids[c] - 1);
      ++seen[cell];
      EXPECT_EQ(piece.cells.shapes[c], mesh.cells.shapes[cell]);
      ASSERT_EQ(piece.cells.vertex_count(c), mesh.cells.vertex_count(cell));
      for (int k = 0; k < piece.cells.vertex_count(c); ++k)
        EXPECT_EQ(piece.vertex_ids[piece.cells[c][k]] - 1, mesh.cells[cell][k]);
    }
    for (Index v = 0; v < piece.vertex_count(); ++v)
      EXPECT_EQ(piece.points[v], mesh.points[static_cast<std::size_t>(piece.vertex_ids[v] - 1)]);
  }
  EXPECT_THAT(seen, testing::Each(1));
  EXPECT_EQ(repeated, vertices - mesh.vertex_count());
}
#endif

}  // namespace
}  // namespace meshorder::distributed
