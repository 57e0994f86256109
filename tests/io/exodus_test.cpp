// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two triangles and a quadrilateral in three blocks by label, with sets, sides and arrays.
Mesh labelled() {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 1}, {2, 1, 1}};
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 1, 2});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 2, 3});
  mesh.cells.push_back(Shape::quad, std::array<Index, 4>{1, 4, 5, 2});
  mesh.vertex_ids = {10, 20, 30, 40, 50, 60};
  mesh.cell_ids = {7, 8, 9};
  mesh.data = {{"label", Association::cells, 1, std::vector<std::int32_t>{4, 2, 9}, {}, {}},
               {"side set wall", Association::cells, 1, std::vector<std::int32_t>{12, 12}, {0, 2}, {}},
               {"side set wall factors",
                Association::cells,
                4,
                std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8},
                {0, 2},
                {}},
               {"heat", Association::vertices, 1, std::vector<double>{0, 1, 2, 3, 4, 5}, {}, {}},
               {"flux", Association::cells, 1, std::vector<float>{0.5F, 1.5F}, {1, 2}, {}},
               {"attribute thickness", Association::cells, 1, std::vector<double>{0.25}, {2}, {}},
               {"map owner", Association::vertices, 1, std::vector<std::int32_t>{5, 4, 3, 2, 1, 0}, {}, {}}};
  mesh.sets = {{"upper", Association::cells, {1}},
               {"both", Association::cells, {2, 0}},
               {"held", Association::vertices, {3, 0}},
               {"none", Association::vertices, {}}};
  return mesh;
}

Mesh there_and_back(const Mesh& mesh, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "a.exo", notes);
  return read_mesh(folder.path() / "a.exo");
}

const DataArray& array_of(const Mesh& mesh, std::string_view name, Association association) {
  const DataArray* const array = find_array(mesh, name, association);
  if (array == nullptr) throw InvalidArgument("no array " + std::string(name));
  return *array;
}

TEST(Exodus, HoldsBlocksSetsSidesAttributesMapsAndNumbers) {
  Notes notes;
  const Mesh mesh = labelled();
  const Mesh back = there_and_back(mesh, &notes);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
  EXPECT_THAT(back.cell_blocks, ElementsAre(0, 1, 2));
  EXPECT_EQ(back.vertex_ids, mesh.vertex_ids);
  EXPECT_EQ(back.cell_ids, mesh.cell_ids);
  for (const EntitySet& set : mesh.sets) EXPECT_THAT(back.sets, Contains(set));
  EXPECT_EQ(back.sets.size(), mesh.sets.size());
  for (const DataArray& array : mesh.data) {
    const DataArray& found = array_of(back, array.name, array.association);
    EXPECT_EQ(found.values, array.values) << array.name;
    EXPECT_EQ(found.indices, array.indices) << array.name;
  }
  test::expect_same(there_and_back(back), back);
}

TEST(Exodus, OrderAndBackKeepsAll) {
  const TemporaryFolder folder;
  write_mesh(labelled(), folder.path() / "a.exo");
  test::expect_order_and_back(folder.path() / "a.exo");
  write_mesh(test::mixed_mesh(), folder.path() / "b.exo");
  test::expect_order_and_back(folder.path() / "b.exo");
}

TEST(Exodus, EveryTypeComesBack) {
  std::vector<std::pair<Shape, int>> types = test::linear_types();
  const auto quadratic = test::quadratic_types();
  types.insert(types.end(), quadratic.begin(), quadratic.end());
  for (const auto& [shape, vertices] : types) {
    SCOPED_TRACE(type_name(shape, vertices));
    const Mesh mesh = test::cells_of_type(shape, vertices, 3);
    if (!format_named("exodus").holds(mesh, shape, vertices)) continue;
    Notes notes;
    const Mesh back = there_and_back(mesh, &notes);
    EXPECT_EQ(back.points, mesh.points);
    EXPECT_EQ(back.cells.vertices.size(), mesh.cells.vertices.size());
    // labels decide the order of blocks
    EXPECT_EQ(array_of(back, "temperature", Association::vertices).values,
              array_of(mesh, "temperature", Association::vertices).values);
    EXPECT_THAT(notes, Contains(HasSubstr("stress_X")));
  }
}

TEST(Exodus, LabelsThatCannotBeIdsAreAProperty) {
  Mesh mesh = labelled();
  mesh.data = {{"label", Association::cells, 1, std::vector<std::int32_t>{-3, 2, 2}, {}, {}}};
  const Mesh back = there_and_back(mesh);
  EXPECT_EQ(array_of(back, kLabel, Association::cells).values, Values(std::vector<std::int32_t>{-3, 2, 2}));
  test::expect_same(there_and_back(back), back);
  mesh.data.clear();
  mesh.sets.clear();
  const Mesh plain = there_and_back(mesh);
  EXPECT_EQ(find_array(plain, kLabel, Association::cells), nullptr);
}

TEST(Exodus, SetsMakeBlocksWhereThereAreNoLabels) {
  Mesh mesh = test::tetrahedral_bar(4);
  mesh.data.clear();
  mesh.sets = {{"odd", Association::cells, {1, 3, 5}}, {"some", Association::cells, {3, 4}}};
  const TemporaryFolder folder;
  const Permutation places = write_mesh(mesh, folder.path() / "a.exo");
  const Mesh back = read_mesh(folder.path() / "a.exo");
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    EXPECT_THAT(back.cells[places.old_to_new()[c]], testing::ElementsAreArray(mesh.cells[c]));
  }
  const auto place = [&](Index c) { return places.old_to_new()[c]; };
  EXPECT_THAT(back.sets, Contains(EntitySet{"odd", Association::cells, {place(1), place(3), place(5)}}));
  EXPECT_THAT(back.sets, Contains(EntitySet{"some", Association::cells, {place(3), place(4)}}));
}

TEST(Exodus, TellsWhatItCannotHold) {
  Mesh mesh = labelled();
  mesh.data = {
      {"word", Association::cells, 1, std::vector<std::string>{"a", "b", "c"}, {}, {}},
      {"wide", Association::vertices, 1, std::vector<std::int64_t>{1LL << 60, 0, 0, 0, 0, 1}, {}, {}},
      {"few", Association::vertices, 1, std::vector<double>{1}, {2}, {}}};
  Notes notes;
  (void)there_and_back(mesh, &notes);
  EXPECT_THAT(notes,
              ElementsAre(HasSubstr("'wide' loses digits"), HasSubstr("'word' on cells is not written"),
                          HasSubstr("'few' is given for some vertices; the others get NaN")));
}

TEST(Exodus, GoesThroughMemory) {
  const Mesh mesh = labelled();
  const MemoryFiles files = write_mesh_to_memory(mesh, "exodus", "a.exo");
  ASSERT_EQ(files.files.size(), 1U);
  const std::string& bytes = files.files.front().bytes;
  EXPECT_EQ(format_of_bytes(bytes), &format_named("exodus"));
  const Mesh back = read_mesh(std::as_bytes(std::span(bytes)));
  EXPECT_EQ(back.format, "exodus");
  EXPECT_EQ(back.cells, mesh.cells);
}

TEST(Exodus, ACutFileIsNoticed) {
  const std::string bytes = write_mesh_to_memory(labelled(), "exodus", "a.exo").files.front().bytes;
  test::expect_truncation_is_noticed("a.exo", bytes);
}

TEST(Exodus, ChangedBytesOfTheHeaderAreReadOrRefused) {
  const std::string bytes = write_mesh_to_memory(labelled(), "exodus", "a.exo").files.front().bytes;
  const TemporaryFolder folder;
  constexpr std::array kChanged{'\0', '\x7f', '\xff'};
  for (std::size_t at = 3; at < std::min<std::size_t>(bytes.size(), 6000); at += 5) {
    std::string changed = bytes;
    changed[at] = kChanged[at % kChanged.size()];
    try {
      (void)read_mesh(folder.file("a.exo", changed));
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.exo")) << at;
    }
  }
}

TEST(Exodus, OtherFilesAreRefused) {
  EXPECT_THAT(test::read_error(TemporaryFolder().file("a.exo", "no mesh at all")),
              HasSubstr("is not a file of netCDF"));
  const TemporaryFolder folder;
  EXPECT_THAT(test::read_error(folder.path() / "missing.exo"), HasSubstr("no such file"));
  EXPECT_THAT(test::read_error(folder.file("b.exo", std::string("CDF\x07") + std::string(40, '\0'))),
              HasSubstr("the version of netCDF is 7"));
}

}  // namespace
}  // namespace meshorder
