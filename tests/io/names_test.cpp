// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "support/round_trip.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {
namespace {

using namespace std::string_literals;

/// Names that a format could misread.
std::vector<std::string> difficult_names() {
  std::vector<std::string> names{
      "",
      " ",
      "\t",
      "-1",
      "0",
      "7",
      ".",
      "..",
      "#",
      "# comment",
      "%",
      "%20",
      "%zz",
      "$End",
      "$EndPhysicalNames",
      "*SET",
      "*END STEP",
      "**",
      "&amp;",
      "<DataArray Name=\"x\">",
      "]]>",
      "-->",
      "a b",
      " a ",
      "a,b",
      "a=b",
      "a/b",
      "/",
      "a\\",
      "\\",
      "a\\\\",
      "a\\ \\",
      "\"",
      "a\"b",
      "'",
      "a'b",
      "`",
      "a\nb",
      "a\n-1\n",
      "a\nf 1 2 3",
      "a\r",
      "a\r\nb",
      "\n",
      "a\vb",
      "a\fb",
      "a\x1b[31m",
      "a\x01",
      "a\x7f",
      "a\0b"s,
      "Größe",
      "\u202eabc",
      "\u2028",
      "\U0001F600",
      "Stra\xdf"
      "e",
      "\xff\xfe",
      "\xe2\x82",
      "SEND_RECEIVE",
      "allElements",
      "NULL_ARRAY",
      "unmarked",
      "vertex",
      "nan",
      "END",
      "{{title}}",
  };
  for (const std::size_t length :
       {20U, 31U, 32U, 33U, 40U, 41U, 63U, 64U, 65U, 80U, 81U, 127U, 255U, 256U, 1000U}) {
    names.emplace_back(length, 'n');
    std::string accents;
    while (accents.size() < length) accents += "é";
    names.push_back("x" + accents);
  }
  return names;
}

/// The mesh with an array on vertices, an array on cells, and sets, all of that name.
Mesh named(const Mesh& bare, const std::string& name) {
  Mesh mesh = bare;
  const auto vertices = static_cast<std::size_t>(mesh.vertex_count());
  const auto cells = static_cast<std::size_t>(mesh.cell_count());
  mesh.data.push_back({name, Association::vertices, 1, std::vector<double>(vertices, 0.5), {}, {}});
  mesh.data.push_back({name, Association::cells, 1, std::vector<double>(cells, 0.25), {}, {}});
  mesh.sets.push_back({name, Association::vertices, {0, 2}});
  mesh.sets.push_back({name, Association::cells, {1, 2}});
  mesh.sets.push_back({"others", Association::cells, {0}});
  return mesh;
}

/// The formats except those for matrices, each with a mesh that it can hold.
std::vector<std::pair<const Format*, Mesh>> formats_and_meshes() {
  Mesh tetrahedra = test::tetrahedral_bar(2);
  tetrahedra.data.clear();
  tetrahedra.sets.clear();
  for (Point& point : tetrahedra.points) {
    for (double& x : point) x = static_cast<float>(static_cast<int>(8 * x)) / 8;  // few digits
  }
  Mesh triangles = test::triangles_and_line(4);
  triangles.data.clear();
  triangles.sets.clear();
  std::vector<std::pair<const Format*, Mesh>> result;
  for (const Format& format : all_formats()) {
    for (const Mesh& mesh : {tetrahedra, triangles}) {
      if (!format.holds(mesh, mesh.cells.shapes.front(), mesh.cells.vertex_count(0))) continue;
      result.emplace_back(&format, mesh);
      break;
    }
  }
  return result;
}

bool names_it(const Notes& notes, const std::string& name) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find("'" + name) != std::string::npos; });
}

/// The members of all sets, sorted.
std::multiset<std::vector<Index>> members_of(const Mesh& mesh) {
  std::multiset<std::vector<Index>> result;
  for (EntitySet set : mesh.sets) {
    std::sort(set.members.begin(), set.members.end());
    result.insert(std::move(set.members));
  }
  return result;
}

class Names : public testing::Test {
 protected:
  const std::vector<std::pair<const Format*, Mesh>> formats_ = formats_and_meshes();
};

TEST_F(Names, AreKeptOrNotedAndChangeNothingElse) {
  const auto count = [](const Mesh& mesh, const std::string& wanted) {
    const auto is_it = [&](const auto& item) { return item.name == wanted; };
    return std::count_if(mesh.data.begin(), mesh.data.end(), is_it) +
           std::count_if(mesh.sets.begin(), mesh.sets.end(), is_it);
  };
  for (const auto& [format, bare] : formats_) {
    const Mesh plain = test::read_back(test::written_as(named(bare, "plain"), *format).files, *format);
    for (const std::string& name : difficult_names()) {
      SCOPED_TRACE(format->key() + ": " + testing::PrintToString(name));
      const test::Written written = test::written_as(named(bare, name), *format);
      Mesh found;
      ASSERT_NO_THROW(found = test::read_back(written.files, *format)) << written.files.front().bytes;
      EXPECT_EQ(found.points, plain.points);
      EXPECT_EQ(found.cells, plain.cells);
      EXPECT_EQ(found.data.size(), plain.data.size());
      EXPECT_EQ(members_of(found), members_of(plain));
      EXPECT_TRUE(names_it(written.notes, name) || count(found, name) == count(plain, "plain"));
    }
  }
}

TEST_F(Names, ThatBecomeAlikeStayApart) {
  const std::vector<std::string> alike{"a b",
                                       "a_b",
                                       "a\tb",
                                       "a\nb",
                                       "a\x01"
                                       "b",
                                       "a\x7f"
                                       "b",
                                       "a b ",
                                       "A B",
                                       "a\\x01b",
                                       std::string(300, 'c'),
                                       std::string(301, 'c'),
                                       std::string(300, 'c') + "d"};
  for (const auto& [format, bare] : formats_) {
    SCOPED_TRACE(format->key());
    Mesh mesh = bare;
    Mesh numbered = bare;
    for (std::size_t i = 0; i < alike.size(); ++i) {
      // the members differ, and no set has all cells of a block
      const auto at = static_cast<Index>(i);
      mesh.sets.push_back({alike[i], Association::cells, {at % 3, 3}});
      mesh.sets.back().members.resize(1 + i % 2);
      numbered.sets.push_back({std::string(i + 1, 's'), Association::cells, mesh.sets.back().members});
    }
    EXPECT_EQ(members_of(test::read_back(test::written_as(mesh, *format).files, *format)),
              members_of(test::read_back(test::written_as(numbered, *format).files, *format)));
  }
}

}  // namespace
}  // namespace meshorder
