// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/kept_cells.hpp"

#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A point, two triangles and two tetrahedra, interleaved, with all that cells may have.
Mesh solid_with_boundary() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 2, 1});
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::vertex, std::array<Index, 1>{4});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{1, 2, 4});
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{1, 2, 3, 4});
  mesh.cell_ids = {10, 11, 12, 13, 14};
  mesh.data = {
      {"dense", Association::cells, 2, std::vector<double>{0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5}, {}, {}},
      {"some", Association::cells, 1, std::vector<std::int32_t>{7, 8, 9}, {4, 0, 1}, {}},
      {"of faces", Association::cells, 1, std::vector<std::int32_t>{7}, {3}, {}},
      {"of vertices", Association::vertices, 1, std::vector<double>{0, 1, 2, 3, 4}, {}, {}}};
  mesh.sets = {{"wall", Association::cells, {0, 3}},
               {"mixed", Association::cells, {4, 3}},
               {"empty", Association::cells, {}},
               {"held", Association::vertices, {3}}};
  return mesh;
}

TEST(KeepCells, KeepsAllThatBelongsToThem) {
  Mesh mesh = solid_with_boundary();
  mesh.cell_blocks = {0, 2, 4};
  Notes notes;
  EXPECT_THAT(keep_cells(mesh, {.format = "vega", .notes = &notes}), ElementsAre(1, 4));
  EXPECT_THAT(notes, ElementsAre("2 triangles are left out: Vega cannot hold them",
                                 "1 vertex is left out: Vega cannot hold it",
                                 "the array 'of faces' is left out with all its cells",
                                 "the set 'wall' is left out with all its cells"));
  Mesh expected = solid_with_boundary();
  expected.cells = {};
  expected.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  expected.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{1, 2, 3, 4});
  expected.cell_ids = {11, 14};
  expected.cell_blocks = {0, 1};
  expected.data = {{"dense", Association::cells, 2, std::vector<double>{1, 1.5, 4, 4.5}, {}, {}},
                   {"some", Association::cells, 1, std::vector<std::int32_t>{7, 9}, {1, 0}, {}},
                   expected.data[3]};
  expected.sets = {{"mixed", Association::cells, {1}}, {"empty", Association::cells, {}}, expected.sets[3]};
  test::expect_same(mesh, expected);
  check_mesh(mesh);
}

TEST(KeepCells, KeepsTheCellsOfOneDimension) {
  for (const auto& [dimension, positions] :
       {std::pair{3, std::vector<Index>{1, 4}}, {2, std::vector<Index>{0, 3}}, {0, std::vector<Index>{2}}}) {
    Mesh mesh = solid_with_boundary();
    Notes notes;
    EXPECT_EQ(keep_cells(mesh, {.dimension = dimension, .notes = &notes}), positions);
    EXPECT_EQ(mesh.cells.highest_dimension(), dimension);
    EXPECT_EQ(mesh.vertex_count(), 5);
    for (const std::string& note : notes) EXPECT_THAT(note, HasSubstr("with all its cells"));
  }
  Mesh mesh = solid_with_boundary();
  const Mesh whole = mesh;
  EXPECT_THROW(keep_cells(mesh, {.dimension = 1}), InvalidArgument);
  EXPECT_THROW(keep_cells(mesh, {.dimension = 4}), InvalidArgument);
  EXPECT_THROW(keep_cells(mesh, {.format = "none"}), InvalidArgument);
  test::expect_same(mesh, whole);
}

TEST(WriteMesh, LeavesOutCellsOfLowerDimensionsAndReturnsTheirPlaces) {
  const TemporaryFolder folder;
  const Mesh mesh = solid_with_boundary();
  for (const auto& [name, cells, first_places] :
       {std::tuple{"a.veg", 2, std::vector<Index>{2, 0, 3, 4, 1}},
        std::tuple{"a.node", 4, std::vector<Index>{2, 0, 4, 3, 1}},
        std::tuple{"a.mesh", 4, std::vector<Index>{2, 0, 4, 3, 1}}}) {
    SCOPED_TRACE(name);
    const Permutation places = write_mesh(mesh, folder.path() / name);
    EXPECT_THAT(std::vector<Index>(places.old_to_new().begin(), places.old_to_new().end()), first_places);
    const Mesh back = read_mesh(folder.path() / name);
    EXPECT_EQ(back.points, mesh.points);
    ASSERT_EQ(back.cell_count(), cells);
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      const Index place = places.old_to_new()[c];
      if (place >= cells) continue;
      EXPECT_THAT(back.cells[place], testing::ElementsAreArray(mesh.cells[c]));
    }
  }
}

TEST(WriteMesh, RefusesEveryLossIfStrict) {
  const TemporaryFolder folder;
  const auto refusal = [&](const Mesh& mesh, const char* name) -> std::string {
    try {
      write_mesh(mesh, folder.path() / name, {.strict = true});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  Mesh mesh = solid_with_boundary();
  EXPECT_THAT(refusal(mesh, "a.veg"), HasSubstr("Vega cannot hold a cell of type triangle"));
  keep_cells(mesh, {.dimension = 3});
  EXPECT_THAT(refusal(mesh, "a.veg"), HasSubstr("the set 'held' of vertices is not written"));
  mesh.sets.clear();
  EXPECT_THAT(refusal(mesh, "a.veg"), HasSubstr("is not written: Vega cannot hold it"));
  mesh.data.clear();
  EXPECT_THAT(refusal(mesh, "a.node"), HasSubstr("the ids of cells are not written"));
  EXPECT_THAT(folder.names(), IsEmpty());
  mesh.cell_ids.clear();
  EXPECT_EQ(refusal(mesh, "a.veg"), "");
  EXPECT_EQ(read_mesh(folder.path() / "a.veg").cells, mesh.cells);
}

/// Meshes of every cell type, alone and together.
std::vector<Mesh> meshes_of_all_types() {
  const test::CellTypes types = test::common_types({{Shape::polygon, 5},
                                                    {Shape::poly_vertex, 3},
                                                    {Shape::polyline, 4},
                                                    {Shape::triangle_strip, 5},
                                                    {Shape::pyramid, 14},
                                                    {Shape::triangle, 10},
                                                    {Shape::tetrahedron, 20},
                                                    {Shape::hexahedron, 64}});
  std::vector<Mesh> meshes{test::mixed_mesh(), solid_with_boundary()};
  for (const auto& [shape, vertices] : types) meshes.push_back(test::cells_of_type(shape, vertices, 2));
  // pairs of types on the vertices of the first
  for (const auto& [first, width] : types) {
    for (const auto& [second, count] : types) {
      if (count > width || (first == second && count == width)) continue;
      Mesh& mesh = meshes.emplace_back(test::cells_of_type(first, width, 1));
      std::vector<Index> vertices(static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) vertices[static_cast<std::size_t>(i)] = i;
      mesh.data.clear();
      mesh.sets.clear();
      mesh.cells.push_back(second, vertices);
    }
  }
  const std::size_t in_space = meshes.size();
  for (std::size_t m = 0; m < in_space; ++m) {
    if (meshes[m].cells.highest_dimension() > 2) continue;
    Mesh& flat = meshes.emplace_back(meshes[m]);
    for (Point& point : flat.points) point[2] = 0;
  }
  return meshes;
}

TEST(WriteMesh, AdvisesOnlyFormatsThatTakeTheMesh) {
  int refusals = 0;
  int pieces = 0;
  for (const Mesh& mesh : meshes_of_all_types()) {
    std::set<std::string> tried;  // most refusals of one mesh name the same formats
    for (const Format& format : all_formats()) {
      std::string refusal;
      try {
        (void)write_mesh_to_memory(mesh, format.key(), "a");
      } catch (const InputError& error) {
        refusal = error.what();
      }
      if (refusal.empty()) continue;
      ++refusals;
      SCOPED_TRACE(refusal);
      const std::size_t advice = refusal.find("; write ");
      if (advice == std::string::npos) {
        EXPECT_THAT(refusal, HasSubstr("no format that meshorder writes holds all of its cells"));
        continue;
      }
      std::istringstream words(refusal.substr(advice + 8));
      for (std::string word; words >> word;) {
        if (word == "or") continue;
        if (word.back() == ',') word.pop_back();
        ++pieces;
        if (!tried.insert(word).second) continue;
        const TemporaryFolder folder;
        const auto path = (folder.path() / "b").concat(word);
        Notes notes;
        EXPECT_NO_THROW(write_mesh(mesh, path, &notes)) << word;
        EXPECT_EQ(read_mesh(path).cell_count(), mesh.cell_count()) << word;
      }
    }
  }
  EXPECT_GT(refusals, 300);
  EXPECT_GT(pieces, 300);
}

}  // namespace
}  // namespace meshorder
