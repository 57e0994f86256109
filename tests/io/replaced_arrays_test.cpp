// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/round_trip.hpp"
#include "support/sample_meshes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

/// Tetrahedra, or triangles if the format holds no tetrahedra, or no cells for a format of matrices; with
/// arrays on all and on some vertices and cells. Values are whole numbers that 32-bit formats can hold.
Mesh with_arrays(const Format& format) {
  Mesh mesh = test::tetrahedral_bar(2);
  if (!format.holds(mesh, Shape::tetrahedron, 4)) {
    mesh = test::triangles_and_line(4);
    if (!format.holds(mesh, Shape::triangle, 3)) return {};
  }
  mesh.data.clear();
  mesh.sets.clear();
  const std::vector<Index> some{1, 0};
  for (const Association of : {Association::vertices, Association::cells}) {
    const auto count =
        static_cast<std::size_t>(of == Association::vertices ? mesh.vertex_count() : mesh.cell_count());
    mesh.data.push_back({.name = "all", .association = of, .values = std::vector<double>(count, 1)});
    mesh.data.push_back(
        {.name = "some", .association = of, .values = std::vector<double>(some.size(), 1), .indices = some});
  }
  return mesh;
}

/// All values of all arrays, as texts.
std::set<std::string> values_of(const std::vector<DataArray>& arrays) {
  std::set<std::string> all;
  for (const DataArray& array : arrays) {
    std::visit(
        [&](const auto& values) {
          for (const auto& value : values) all.insert(fmt::format("{}", value));
        },
        array.values);
  }
  return all;
}

bool are_noted(const DataArray& array, const Notes& notes) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) {
    return note.find("'" + array.name + "'") != std::string::npos;
  });
}

void expect_written_or_noted(const Mesh& mesh, const DataArray& array, const Format& format) {
  const test::Written written = test::written_as(mesh, format);
  const Mesh back = test::read_back(written.files, format);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
  const std::set<std::string> found = values_of(back.data);
  const std::set<std::string> wanted = values_of({array});
  EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end()) ||
              are_noted(array, written.notes));
}

/// Gives an array new numbers, all different, for `rows` vertices or cells.
void fill(DataArray& array, Index rows, Index components) {
  std::vector<double> values(static_cast<std::size_t>(rows * components));
  std::iota(values.begin(), values.end(), 100.0);
  array.values = std::move(values);
  array.components = components;
  array.component_names.clear();
}

TEST(ReplacedArrays, AreWrittenWholeOrNoted) {
  using Change = std::function<void(DataArray&, Index count)>;
  const std::vector<std::pair<std::string, Change>> changes{
      {"of three components", [](DataArray& array, Index /*count*/) { fill(array, row_count(array), 3); }},
      {"on others",
       [](DataArray& array, Index /*count*/) {
         array.indices = {2, 0, 3};
         fill(array, 3, 1);
       }},
      {"on all",
       [](DataArray& array, Index count) {
         array.indices.clear();
         fill(array, count, 1);
       }},
      {"of texts",
       [](DataArray& array, Index /*count*/) {
         array.values = std::vector<std::string>(static_cast<std::size_t>(row_count(array)), "text");
         array.components = 1;
       }},
  };
  for (const Format& format : all_formats()) {
    const Mesh written = with_arrays(format);
    if (written.cell_count() == 0) continue;
    const Mesh mesh = test::read_back(test::written_as(written, format).files, format);
    for (std::size_t a = 0; a < mesh.data.size(); ++a) {
      for (const auto& [what, change] : changes) {
        SCOPED_TRACE(format.key() + ": " + mesh.data[a].name + " on " +
                     std::string(to_string(mesh.data[a].association)) + " " + what);
        Mesh changed = mesh;
        change(changed.data[a], changed.data[a].association == Association::vertices ? mesh.vertex_count()
                                                                                     : mesh.cell_count());
        expect_written_or_noted(changed, changed.data[a], format);
      }
    }
  }
}

}  // namespace
}  // namespace meshorder
