// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/exodus/exodus.hpp"

#include "io/exodus/netcdf.hpp"
#include "io/format.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
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
  for (const auto& [shape, vertices] : test::common_types()) {
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

TEST(Exodus, BlocksGetIdsThatTheFileHolds) {
  Mesh mesh = labelled();
  mesh.data = {
      {"label", Association::cells, 1, std::vector<std::int32_t>{2147483647, -1, 2147483647}, {}, {}}};
  const Mesh back = there_and_back(mesh);
  EXPECT_EQ(array_of(back, kLabel, Association::cells).values,
            Values(std::vector<std::int32_t>{2147483647, -1, 2147483647}));
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

TEST(Exodus, ReportsWhatItCannotHold) {
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

/// Writes two triangles in two blocks, and what `put` adds.
void write_two_blocks(const std::filesystem::path& path, const std::function<void(exodus::NcOutput&)>& put) {
  exodus::NcOutput file(path, exodus::plain_storage(false));
  for (const auto& [name, length] :
       {std::pair("time_step", 1), std::pair("len_name", 33), std::pair("num_dim", 2),
        std::pair("num_nodes", 3), std::pair("num_elem", 2), std::pair("num_el_blk", 2), std::pair("one", 1),
        std::pair("three", 3)}) {
    (void)file.dimension({name, static_cast<std::size_t>(length)});
  }
  for (const char* const name : {"coordx", "coordy"}) {
    const exodus::NcSink sink = file.variable(name, exodus::kDouble, {"num_nodes"});
    file.later([sink, name] {
      sink.list(name[5] == 'x' ? std::vector<double>{0, 1, 0} : std::vector<double>{0, 0, 1});
    });
  }
  for (const char* const name : {"connect1", "connect2"}) {
    const exodus::NcSink sink =
        file.variable(name, exodus::kInt, {"one", "three"}, {exodus::text_attribute("elem_type", "TRI3")});
    file.later([sink] { sink.part({0, 0}, {1, 3}, std::vector<std::int32_t>{1, 2, 3}); });
  }
  put(file);
  file.finish();
}

/// Declares variables of nodes or elements with names of one letter each.
void put_names(exodus::NcOutput& file, const std::string& of, const std::string& letters) {
  const std::string count = "num_" + of + "_var";
  (void)file.dimension({count, letters.size()});
  const exodus::NcSink sink = file.variable("name_" + of + "_var", exodus::kChar, {count, "len_name"});
  std::string table(letters.size() * 33, '\0');
  for (std::size_t i = 0; i < letters.size(); ++i) table[i * 33] = letters[i];
  file.later([sink, table, rows = letters.size()] { sink.bytes({rows, 33}, table); });
}

void put_values(exodus::NcOutput& file, const std::string& name, const std::string& dimension,
                exodus::NcType type, const std::vector<double>& values) {
  const exodus::NcSink sink = file.variable(name, type, {"time_step", dimension});
  file.later([sink, values] { sink.part({0, 0}, {1, values.size()}, values); });
}

TEST(Exodus, NamesWithoutValuesGetNone) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.exo";
  write_two_blocks(path, [](exodus::NcOutput& file) {
    put_names(file, "nod", "uvw");
    put_values(file, "vals_nod_var2", "num_nodes", exodus::kDouble, {1, 2, 3});
    put_names(file, "elem", "ab");
    put_values(file, "vals_elem_var2eb1", "one", exodus::kDouble, {4});
  });
  const Mesh mesh = read_mesh(path);
  ASSERT_EQ(mesh.data.size(), 3U);  // "v", "b" and the labels of blocks
  EXPECT_EQ(array_of(mesh, "v", Association::vertices).values, Values(std::vector<double>{1, 2, 3}));
  test::expect_order_and_back(path);
  // in memory, where netCDF fills values that are not written
  const MemoryFiles files = write_mesh_to_memory(mesh, "exodus", "b.exo");
  test::expect_same(read_mesh(std::as_bytes(std::span(files.files.front().bytes))), mesh);
}

TEST(Exodus, ReportsWhichNamesOfVariablesOfSetsChange) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.exo";
  write_two_blocks(path, [](exodus::NcOutput& file) {
    (void)file.dimension({"num_node_sets", 1});
    const exodus::NcSink sink = file.variable("node_ns1", exodus::kInt, {"one"});
    file.later([sink] { sink.list(std::vector<std::int32_t>{2}); });
    put_names(file, "nset", "\t");
    put_values(file, "vals_nset_var1ns1", "one", exodus::kDouble, {4});
  });
  Notes notes;
  write_mesh(read_mesh(path), folder.path() / "b.exo", &notes);
  EXPECT_THAT(notes, ElementsAre("the name '\t' is written as '_'"));
}

TEST(Exodus, ValuesOfBlocksOfMixedTypesStay) {
  constexpr double kLarge = 1e165;
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.exo";
  for (const auto& [first, second] :
       {std::pair(exodus::kDouble, exodus::kFloat), std::pair(exodus::kFloat, exodus::kDouble),
        std::pair(exodus::kInt, exodus::kFloat)}) {
    SCOPED_TRACE(second);
    const auto value_of = [](exodus::NcType type) {
      return type == exodus::kDouble ? kLarge : type == exodus::kInt ? 16777217 : 0.5;
    };
    write_two_blocks(path, [&, first = first, second = second](exodus::NcOutput& file) {
      put_names(file, "elem", "a");
      put_values(file, "vals_elem_var1eb1", "one", first, {value_of(first)});
      put_values(file, "vals_elem_var1eb2", "one", second, {value_of(second)});
    });
    EXPECT_EQ(array_of(read_mesh(path), "a", Association::cells).values,
              Values(std::vector<double>{value_of(first), value_of(second)}));
    test::expect_order_and_back(path);
  }
}

TEST(Exodus, ArraysThatNoLongerFitTheirTypeAreWrittenInDouble) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.exo";
  write_two_blocks(path, [](exodus::NcOutput& file) {
    put_names(file, "nod", "ui");
    put_values(file, "vals_nod_var1", "num_nodes", exodus::kFloat, {0.5, 1, 2});
    put_values(file, "vals_nod_var2", "num_nodes", exodus::kInt, {1, 2, 3});
  });
  Mesh mesh = read_mesh(path);
  for (DataArray& array : mesh.data) {
    if (array.association == Association::vertices)
      array.values = std::vector<double>{0.1, 1e165, 2147483648.0};
  }
  test::expect_same(there_and_back(mesh), mesh);
}

TEST(Exodus, TypesHoldWhatTheyCanTellApart) {
  using exodus::can_hold;
  const auto real = [](double value) { return Values(std::vector<double>{0, value}); };
  const auto whole = [](std::int64_t value) { return Values(std::vector<std::int64_t>{0, value}); };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {0.5, -HUGE_VAL, kNan, 16777216.0, 1e30F * 1.0})
    EXPECT_TRUE(can_hold(exodus::kFloat, real(value))) << value;
  for (const double value : {0.1, 1e165, -1e-200, 16777217.0})
    EXPECT_FALSE(can_hold(exodus::kFloat, real(value))) << value;
  EXPECT_TRUE(can_hold(exodus::kFloat, whole(-16777216)));
  EXPECT_FALSE(can_hold(exodus::kFloat, whole(16777217)));
  EXPECT_TRUE(can_hold(exodus::kDouble, whole(-(std::int64_t{1} << 53))));
  EXPECT_FALSE(can_hold(exodus::kDouble, whole((std::int64_t{1} << 53) + 1)));
  EXPECT_TRUE(can_hold(exodus::kInt, real(-2147483648.0)));
  for (const double value : {0.5, 2147483648.0, -2147483649.0, HUGE_VAL, kNan})
    EXPECT_FALSE(can_hold(exodus::kInt, real(value))) << value;
  EXPECT_FALSE(can_hold(exodus::kInt64, real(9223372036854775808.0)));
  EXPECT_FALSE(can_hold(exodus::kInt64, Values(std::vector<std::uint64_t>{std::uint64_t{1} << 63})));
  EXPECT_FALSE(can_hold(exodus::kDouble, Values(std::vector<std::string>{"1"})));
  EXPECT_FALSE(can_hold(exodus::kChar, whole(1)));
}

/// The values of an array as real numbers.
std::vector<double> real_values(const DataArray& array) {
  return std::visit(
      [](const auto& values) {
        std::vector<double> result;
        if constexpr (std::is_arithmetic_v<typename std::decay_t<decltype(values)>::value_type>)
          result.assign(values.begin(), values.end());
        return result;
      },
      array.values);
}

/// The rows of an array by the vertex or cell of the whole mesh that each belongs to; NaN is −1.
std::map<Index, std::vector<double>> rows_of(const DataArray& array, bool is_dense, Index first) {
  const std::vector<double> values = real_values(array);
  const auto width = static_cast<std::size_t>(array.components);
  std::map<Index, std::vector<double>> rows;
  for (std::size_t k = 0; k * width < values.size(); ++k) {
    std::vector<double>& row = rows[first + (is_dense ? static_cast<Index>(k) : array.indices[k])];
    for (std::size_t i = k * width; i < (k + 1) * width; ++i)
      row.push_back(std::isnan(values[i]) ? -1 : values[i]);
  }
  return rows;
}

/// Reads a file in `parts` parts, and compares these with the whole.
void expect_parts_of_the_whole(const std::filesystem::path& path, Index parts) {
  const Mesh whole = read_mesh(path);
  std::vector<std::map<Index, std::vector<double>>> rows(whole.data.size());
  // by their places in the file's list
  std::vector<std::map<Index, Index>> members(whole.sets.size());
  std::vector<std::map<Index, Index>> listed(whole.data.size());
  Mesh joined;
  const auto range = [&](Index count, Index p) {
    return MeshRange{static_cast<Index>(Offset{count} * p / parts),
                     static_cast<Index>(Offset{count} * (p + 1) / parts)};
  };
  for (Index p = 0; p < parts; ++p) {
    const MeshRanges ranges{range(whole.vertex_count(), p), range(whole.cell_count(), p)};
    Notes notes;
    const MeshPart part = exodus::read_part(path, ranges, exodus::PartContent::all, notes);
    const Mesh& mesh = part.mesh;
    const auto first = [&](Association of) {
      return of == Association::vertices ? ranges.vertices.first : ranges.cells.first;
    };
    joined.points.insert(joined.points.end(), mesh.points.begin(), mesh.points.end());
    for (Index c = 0; c < mesh.cell_count(); ++c) joined.cells.push_back(mesh.cells.shapes[c], mesh.cells[c]);
    joined.vertex_ids.insert(joined.vertex_ids.end(), mesh.vertex_ids.begin(), mesh.vertex_ids.end());
    joined.cell_ids.insert(joined.cell_ids.end(), mesh.cell_ids.begin(), mesh.cell_ids.end());
    ASSERT_EQ(mesh.data.size(), whole.data.size());
    for (std::size_t k = 0; k < mesh.data.size(); ++k) {
      EXPECT_EQ(mesh.data[k].name, whole.data[k].name);
      EXPECT_EQ(part.arrays[k].is_partial, !whole.data[k].is_dense());
      rows[k].merge(rows_of(mesh.data[k], !part.arrays[k].is_partial, first(mesh.data[k].association)));
      for (std::size_t i = 0; i < part.arrays[k].entries.size(); ++i)
        listed[k][part.arrays[k].entries[i]] = first(mesh.data[k].association) + mesh.data[k].indices[i];
    }
    ASSERT_EQ(mesh.sets.size(), whole.sets.size());
    for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
      EXPECT_EQ(mesh.sets[s].name, whole.sets[s].name);
      EXPECT_EQ(part.sets[s].size, index_size(whole.sets[s].members));
      for (std::size_t k = 0; k < mesh.sets[s].members.size(); ++k)
        members[s][part.sets[s].entries[k]] = first(mesh.sets[s].association) + mesh.sets[s].members[k];
    }
  }
  EXPECT_EQ(joined.points, whole.points);
  EXPECT_EQ(joined.cells, whole.cells);
  EXPECT_EQ(joined.vertex_ids, whole.vertex_ids);
  EXPECT_EQ(joined.cell_ids, whole.cell_ids);
  for (std::size_t k = 0; k < whole.data.size(); ++k) {
    EXPECT_EQ(rows[k], rows_of(whole.data[k], whole.data[k].is_dense(), 0)) << whole.data[k].name;
    std::vector<Index> in_order;
    for (const auto& [place, member] : listed[k]) in_order.push_back(member);
    if (!in_order.empty()) {
      EXPECT_EQ(in_order, whole.data[k].indices) << whole.data[k].name;
    }
  }
  for (std::size_t s = 0; s < whole.sets.size(); ++s) {
    Index entry = 0;
    for (const auto& [place, member] : members[s]) {
      EXPECT_EQ(place, entry) << whole.sets[s].name;
      EXPECT_EQ(member, whole.sets[s].members[entry++]) << whole.sets[s].name;
    }
  }
}

TEST(Exodus, PartsAreThoseOfTheWhole) {
  const TemporaryFolder folder;
  Mesh mesh = labelled();
  write_mesh(mesh, folder.path() / "a.e");
  Mesh mixed = test::mixed_mesh();
  for (Index v = mixed.vertex_count(); v > 0; --v) mixed.vertex_ids.push_back(3 * v);
  write_mesh(mixed, folder.path() / "b.e");
  for (const Index parts : {1, 2, 3, 11}) {
    expect_parts_of_the_whole(folder.path() / "a.e", parts);
    expect_parts_of_the_whole(folder.path() / "b.e", parts);
  }
}

TEST(Exodus, PartsOfLongListsAreReadPieceByPiece) {
  constexpr Index kMany = 600'000;  // more than are read at a time
  Mesh mesh;
  std::vector<double> factors;
  EntitySet all{"all", Association::vertices, {}};
  for (Index v = 0; v < kMany; ++v) {
    mesh.points.push_back({1.0 * v, 0, 0});
    all.members.push_back(kMany - 1 - v);
    factors.push_back(0.5 * v);
  }
  mesh.cells.push_back(Shape::line, std::array<Index, 2>{0, kMany - 1});
  mesh.data = {{"node set all factors", Association::vertices, 1, factors, all.members, {}}};
  mesh.sets = {all};
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "a.e");
  expect_parts_of_the_whole(folder.path() / "a.e", 2);
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
              HasSubstr("is not a netCDF file"));
  const TemporaryFolder folder;
  EXPECT_THAT(test::read_error(folder.path() / "missing.exo"), HasSubstr("no such file"));
  EXPECT_THAT(test::read_error(folder.file("b.exo", std::string("CDF\x07") + std::string(40, '\0'))),
              HasSubstr("the version of netCDF is 7"));
}

}  // namespace
}  // namespace meshorder
