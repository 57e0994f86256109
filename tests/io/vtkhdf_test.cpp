// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "io/vtk/vtk.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two tetrahedra and a triangle with arrays of several number types, sorted by name, and with sets, fields
/// and roles as in VTK's formats.
Mesh grid() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0.1}};
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{1, 2, 3, 4});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 2, 1});
  mesh.data = {{"heat", Association::vertices, 1, std::vector<double>{0, 1, 2, 3, 4}, {}, {}},
               {"shift", Association::vertices, 2, std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {}, {}},
               {"big", Association::cells, 1, std::vector<std::uint64_t>{1, UINT64_MAX, 3}, {}, {}},
               {"small", Association::cells, 1, std::vector<std::int8_t>{-1, 2, 3}, {}, {}}};
  mesh.sets = {{"held", Association::vertices, {1, 4}}, {"skin", Association::cells, {2, 0}}};
  auto metadata = std::make_shared<vtk::VtkMetadata>();
  metadata->fields = {
      {"pairs", Association::vertices, 2, std::vector<std::int32_t>{1, 2, 3, 4}, {}, {}},
      {"title", Association::vertices, 1, std::vector<std::string>{"a", "", "three  "}, {}, {}}};
  metadata->roles = {{vtk::Role::scalars, Association::vertices, "heat", {}},
                     {vtk::Role::global_ids, Association::cells, "big", {}}};
  mesh.format_metadata = metadata;
  return mesh;
}

Mesh through_vtkhdf(const Mesh& mesh, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "a.vtkhdf", notes);
  return read_mesh(folder.path() / "a.vtkhdf", {.notes = notes});
}

TEST(VtkHdf, KeepsArraysSetsFieldsAndRoles) {
  Notes notes;
  const Mesh mesh = grid();
  const Mesh read = through_vtkhdf(mesh, &notes);
  EXPECT_THAT(notes, IsEmpty());
  test::expect_same(read, mesh);
  const auto& metadata = dynamic_cast<const vtk::VtkMetadata&>(*read.format_metadata);
  EXPECT_EQ(metadata.fields, dynamic_cast<const vtk::VtkMetadata&>(*mesh.format_metadata).fields);
  ASSERT_EQ(metadata.roles.size(), 2U);
  EXPECT_EQ(metadata.roles[0].array, "heat");
  EXPECT_EQ(metadata.roles[0].role, vtk::Role::scalars);
  EXPECT_EQ(metadata.roles[1].array, "big");
  EXPECT_EQ(metadata.roles[1].association, Association::cells);
}

TEST(VtkHdf, FilesInMemoryAreThoseOnDisk) {
  const TemporaryFolder folder;
  write_mesh(grid(), folder.path() / "a.vtkhdf");
  const MemoryFiles written = write_mesh_to_memory(grid(), "vtkhdf", "a.vtkhdf");
  const Mesh read = read_mesh(std::as_bytes(std::span(written.files.front().bytes)));
  EXPECT_EQ(read.format, "vtkhdf");
  test::expect_same(read, read_mesh(folder.path() / "a.vtkhdf"));
}

TEST(VtkHdf, TheSameMeshIsTheSameBytes) {
  const TemporaryFolder folder;
  write_mesh(grid(), folder.path() / "a.vtkhdf");
  write_mesh(grid(), folder.path() / "b.vtkhdf");
  EXPECT_EQ(test::content_of(folder.path() / "a.vtkhdf"), test::content_of(folder.path() / "b.vtkhdf"));
}

TEST(VtkHdf, FloatsStayFloatsOnlyWithoutLoss) {
  Mesh mesh = grid();
  auto metadata = std::make_shared<vtk::VtkMetadata>();
  metadata->float_points = true;
  mesh.format_metadata = metadata;
  const auto are_floats = [](const Mesh& read) {
    return dynamic_cast<const vtk::VtkMetadata&>(*read.format_metadata).float_points;
  };
  EXPECT_FALSE(are_floats(through_vtkhdf(mesh)));  // 0.1 is no float
  mesh.points.back()[2] = 0.5;
  EXPECT_TRUE(are_floats(through_vtkhdf(mesh)));
}

TEST(VtkHdf, NamesThatHdf5CannotHoldAreChanged) {
  Mesh mesh = grid();
  mesh.data[0].name = "a/b";
  mesh.data[1].name = ".";
  mesh.data[2].name = "";
  mesh.data[3].name = std::string("x\0y", 3);
  mesh.data.push_back(mesh.data[0]);
  mesh.data.back().name = "a_b";
  mesh.format_metadata.reset();
  mesh.sets.clear();
  Notes notes;
  const Mesh read = through_vtkhdf(mesh, &notes);
  std::vector<std::string> names;
  for (const DataArray& array : read.data) names.push_back(array.name);
  EXPECT_THAT(names, ElementsAre("a_b", "_", "a_b_2", "array", "x_y"));
  EXPECT_EQ(notes.size(), 5U);
  EXPECT_EQ(notes.front(), "the array 'a/b' on vertices is written as 'a_b'");
}

TEST(VtkHdf, SoAreThoseOfFields) {
  Mesh mesh = grid();
  auto metadata = std::make_shared<vtk::VtkMetadata>();
  for (const char* const name : {"a/b", "a_b", ""}) {
    metadata->fields.push_back({name, Association::vertices, 1, std::vector<std::int32_t>{1, 2}, {}, {}});
  }
  mesh.format_metadata = metadata;
  Notes notes;
  const Mesh read = through_vtkhdf(mesh, &notes);
  std::vector<std::string> names;
  for (const DataArray& field : dynamic_cast<const vtk::VtkMetadata&>(*read.format_metadata).fields) {
    names.push_back(field.name);
  }
  EXPECT_THAT(names, ElementsAre("a_b", "a_b_2", "array"));
  EXPECT_THAT(notes,
              ElementsAre("the field 'a/b' is written as 'a_b'", "the field 'a_b' is written as 'a_b_2'",
                          "the field '' is written as 'array'"));
}

TEST(VtkHdf, ReportsWhatItHasNoPlaceFor) {
  Mesh mesh = grid();
  mesh.data[1].component_names = {"x", "y"};
  mesh.data[2].values = std::vector<std::string>{"a", "b", "c"};
  auto metadata = std::make_shared<vtk::VtkMetadata>();
  metadata->facts[{Association::vertices, "heat"}] = {
      Association::vertices, "heat", {}, {}, "<InformationKey/>"};
  mesh.format_metadata = metadata;
  Notes notes;
  const Mesh read = through_vtkhdf(mesh, &notes);
  EXPECT_THAT(notes,
              ElementsAre("the names of the components of 'shift' are not written: VTKHDF cannot hold them",
                          "the array 'big' on cells is not written: VTKHDF cannot hold it",
                          "not written (VTKHDF cannot hold it): the information of the array 'heat'"));
  EXPECT_EQ(find_array(read, "big", Association::cells), nullptr);
}

TEST(VtkHdf, DiffersFromOtherFilesOfHdf5) {
  for (const char* const format : {"vtkhdf", "med"}) {
    const MemoryFiles written = write_mesh_to_memory(test::tetrahedral_bar(1), format, "a");
    const Format* const found = format_of_bytes(written.files.front().bytes);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->key(), format);
  }
}

}  // namespace
}  // namespace meshorder
