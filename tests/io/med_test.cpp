// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
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
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two tetrahedra and two triangles with ids, sets that overlap, and arrays of several number types.
Mesh tagged() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{1, 2, 3, 4});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 2, 1});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{1, 2, 4});
  mesh.vertex_ids = {10, 20, 30, 50, 40};
  mesh.cell_ids = {7, 9, 8, 5};
  mesh.data = {{"heat", Association::vertices, 1, std::vector<double>{0, 1, 2, 3, 4}, {}, {}},
               {"owner", Association::cells, 1, std::vector<std::int32_t>{5, 6, 7, 8}, {}, {}},
               {"parent", Association::vertices, 1, std::vector<std::int64_t>{9, 8}, {1, 3}, {}},
               {"stress", Association::cells, 2, std::vector<double>{1, 2, 3, 4}, {1, 3}, {"SXX", "SYY"}},
               {"u step 1", Association::vertices, 1, std::vector<double>{5, 6, 7, 8, 9}, {}, {}},
               {"u step 2", Association::vertices, 1, std::vector<double>{6, 7, 8, 9, 10}, {}, {}}};
  mesh.sets = {{"both", Association::cells, {0, 3}},
               {"held", Association::vertices, {1, 4}},
               {"left", Association::vertices, {0, 1}},
               {"skin", Association::cells, {2, 3}}};
  return mesh;
}

Mesh through_med(const Mesh& mesh, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "a.med", notes);
  return read_mesh(folder.path() / "a.med");
}

/// The mesh with data and sets sorted by name, without blocks and without labels. In a file of MED, labels
/// are the numbers of families.
Mesh by_name(Mesh mesh) {
  std::erase_if(mesh.data, [](const DataArray& array) { return array.name == kLabel; });
  const auto less = [](const auto& a, const auto& b) {
    return std::pair(a.association, a.name) < std::pair(b.association, b.name);
  };
  std::sort(mesh.data.begin(), mesh.data.end(), less);
  std::sort(mesh.sets.begin(), mesh.sets.end(), less);
  mesh.cell_blocks.clear();
  return mesh;
}

TEST(Med, KeepsIdsSetsArraysAndSteps) {
  Notes notes;
  const Mesh mesh = tagged();
  const Mesh read = through_med(mesh, &notes);
  EXPECT_THAT(notes, IsEmpty());
  test::expect_same(by_name(read), by_name(mesh));
  EXPECT_EQ(read.cell_blocks, (std::vector<Index>{0, 2}));
}

TEST(Med, NumbersFamiliesByTheirGroups) {
  const Mesh read = through_med(tagged());
  const DataArray* const families = find_array(read, kLabel, Association::cells);
  ASSERT_NE(families, nullptr);
  // the cells are in "both", in no set, in "skin", and in both of these sets
  const auto& numbers = std::get<std::vector<std::int32_t>>(families->values);
  EXPECT_EQ(numbers[1], 0);
  EXPECT_EQ(std::set<std::int32_t>(numbers.begin(), numbers.end()), (std::set<std::int32_t>{0, -1, -2, -3}));
}

TEST(Med, ASetThatChangesGetsAFamilyOfItsOwnAndOthersKeepTheirs) {
  Mesh mesh = through_med(tagged());
  const auto families_of = [](const Mesh& of) {
    return std::get<std::vector<std::int32_t>>(find_array(of, kLabel, Association::cells)->values);
  };
  const std::vector<std::int32_t> before = families_of(mesh);
  mesh.sets.push_back({"new", Association::cells, {2}});
  const Mesh read = through_med(mesh);
  const std::vector<std::int32_t> after = families_of(read);
  EXPECT_EQ(after, (std::vector<std::int32_t>{before[0], before[1], -4, before[3]}));
  EXPECT_THAT(read.sets, Contains(EntitySet{"new", Association::cells, {2}}));
}

TEST(Med, WritesFamiliesThatGotMoreComponentsAsAField) {
  Mesh mesh = through_med(tagged());
  for (DataArray& array : mesh.data) {
    if (array.name != kLabel || array.association != Association::cells) continue;
    array.components = 2;
    array.values = std::vector<std::int32_t>{1, 2, 3, 4, 5, 6, 7, 8};
  }
  const Mesh again = through_med(mesh);
  const DataArray* const array = find_array(again, kLabel, Association::cells);
  ASSERT_NE(array, nullptr);
  EXPECT_EQ(array->components, 2);
}

TEST(Med, LabelsWithoutSetsBecomeGroups) {
  Mesh mesh = tagged();
  mesh.sets.clear();
  mesh.data = {{"label", Association::cells, 1, std::vector<std::int32_t>{4, 2, 0, 4}, {}, {}}};
  const Mesh read = through_med(mesh);
  EXPECT_EQ(find_array(read, kLabel, Association::cells)->values, mesh.data[0].values);
  EXPECT_THAT(read.sets, ElementsAre(EntitySet{"label_2", Association::cells, {1}},
                                     EntitySet{"label_4", Association::cells, {0, 3}}));
}

TEST(Med, FollowsCellsThatAreLeftOut) {
  const TemporaryFolder folder;
  Mesh mesh = through_med(tagged());
  // the triangles are left out
  Mesh volumes = mesh;
  volumes.cells = {};
  for (Index c = 0; c < 2; ++c) volumes.cells.push_back(mesh.cells.shapes[c], mesh.cells[c]);
  volumes.cell_ids.resize(2);
  volumes.cell_blocks = {0};
  std::erase_if(volumes.data, [](const DataArray& array) { return array.association == Association::cells; });
  std::erase_if(volumes.sets, [](const EntitySet& set) { return set.association == Association::cells; });
  const Mesh read = through_med(volumes);
  EXPECT_EQ(read.cells, volumes.cells);
  EXPECT_EQ(find_array(read, "owner", Association::cells), nullptr);
  EXPECT_NE(find_array(read, "u step 2", Association::vertices), nullptr);
}

TEST(Med, GroupsCellsThatAProgramHasMixed) {
  // the vertices and the value of each cell
  const auto cells_of = [](const Mesh& mesh) {
    std::set<std::pair<std::vector<Index>, double>> cells;
    const auto& values = std::get<std::vector<double>>(find_array(mesh, "x", Association::cells)->values);
    for (Index c = 0; c < mesh.cell_count(); ++c) {
      cells.insert({{mesh.cells[c].begin(), mesh.cells[c].end()}, values[static_cast<std::size_t>(c)]});
    }
    return cells;
  };
  Mesh mesh = test::mixed_mesh();
  std::vector<double> values(mesh.cells.shapes.size());
  std::iota(values.begin(), values.end(), 0.0);
  mesh.data = {{"x", Association::cells, 1, std::move(values), {}, {}}};
  mesh = through_med(mesh);
  mesh.cell_blocks.clear();
  apply_reordering(mesh, Permutation::identity(mesh.vertex_count()), test::shuffled_cells(mesh, 1));
  const Mesh read = through_med(mesh);
  EXPECT_NE(read.cells, mesh.cells);
  EXPECT_EQ(cells_of(read), cells_of(mesh));
}

TEST(Med, NamesThatAreTooLongAreCutWithANote) {
  Mesh mesh = tagged();
  mesh.sets[0].name = std::string(90, 'a');
  mesh.data[0].name = std::string(70, 'b');
  Notes notes;
  const Mesh read = through_med(mesh, &notes);
  EXPECT_THAT(notes, Contains(HasSubstr("is written as the group '" + std::string(80, 'a') + "'")));
  EXPECT_THAT(notes, Contains(HasSubstr("is written as the field '" + std::string(64, 'b') + "'")));
  EXPECT_NE(find_array(read, std::string(64, 'b'), Association::vertices), nullptr);
}

TEST(Med, CutsNamesBetweenCharacters) {
  Mesh mesh = tagged();
  mesh.data.push_back({"traction",
                       Association::vertices,
                       2,
                       std::vector<double>(2 * mesh.points.size(), 1),
                       {},
                       {"contrainte maxié", "y"}});
  Notes notes;
  const Mesh read = through_med(mesh, &notes);
  EXPECT_THAT(notes, Contains(HasSubstr("are cut to 16 characters")));
  const DataArray* const traction = find_array(read, "traction", Association::vertices);
  ASSERT_NE(traction, nullptr);
  EXPECT_THAT(traction->component_names, ElementsAre("contrainte maxi", "y"));
}

TEST(Med, IsKnownByItsBytesAndReadFromMemory) {
  const MemoryFiles written = write_mesh_to_memory(tagged(), "med", "a.med");
  ASSERT_EQ(written.files.size(), 1U);
  const std::string& bytes = written.files.front().bytes;
  const Mesh read = read_mesh(std::as_bytes(std::span(bytes)));
  EXPECT_EQ(read.format, "med");
  EXPECT_EQ(read.cells, tagged().cells);
}

}  // namespace
}  // namespace meshorder
