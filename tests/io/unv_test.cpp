// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/unv/unv.hpp"

#include "io/format.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using test::with;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Two tetrahedra, a wedge's face, a beam oriented by node 30, a rod and a constraint element, with groups,
// results and units. Numbers have gaps.
constexpr std::string_view kFile =
    "    -1\n"
    "   151\n"
    "a model, made by hand\n"
    "NONE\n"
    "    -1\n"
    "    -1\n"
    "  2411\n"
    "        10         1         1        11\n"
    "   0.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00\n"
    "        20         1         1        11\n"
    "   1.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00\n"
    "        30         1         2         5\n"
    "   0.0000000000000000D+00   1.0000000000000000D+00   0.0000000000000000D+00\n"
    "        40         1         1        11\n"
    "   0.0000000000000000D+00   0.0000000000000000D+00   1.0000000000000001D-01\n"
    "        50         1         1        11\n"
    "   1.0000000000000000D+00   1.0000000000000000D+00   1.0000000000000000D+00\n"
    "    -1\n"
    "    -1\n"
    "  2412\n"
    "         1       111         3         4         7         4\n"
    "        10        20        30        40\n"
    "         2       111         3         5         7         4\n"
    "        20        30        40        50\n"
    "         5        41         1         4         2         3\n"
    "        10        20        30\n"
    "         7        21         2         4         7         2\n"
    "        30         1         1\n"
    "        10        20\n"
    "         8        11         2         4         7         2\n"
    "        20        30\n"
    "         9       122         2         4         7         3\n"
    "        10        30        50\n"
    "    -1\n"
    "    -1\n"
    "  2467\n"
    "         1         0         0         0         0         0         0         5\n"
    "both kinds\n"
    "         7        50         0         0         8         2         0         0\n"
    "         7        10         0         0         8         9         0         0\n"
    "         3         4         0         0\n"
    "         4         0         0         0         0         0         0         2\n"
    "skin\n"
    "         8         5         0         0         8         1         0         0\n"
    "    -1\n"
    "    -1\n"
    "    55\n"
    "displacement\n"
    "NONE\n"
    "NONE\n"
    "NONE\n"
    "NONE\n"
    "         1         1         2         8         2         3\n"
    "         1         1         1\n"
    "  0.00000E+00\n"
    "        50\n"
    "  5.00000E-01  0.00000E+00  1.00000E+00\n"
    "        10\n"
    "  1.00000E-01  1.23456E-07  0.00000E+00\n"
    "    -1\n"
    "    -1\n"
    "   164\n"
    "         1SI                           2\n"
    "    1.0000000000000000E+00\n"
    "    -1\n";

// loads on node 50, in a dataset of which the reader knows only the number
constexpr std::string_view kLoads =
    "    -1\n"
    "   790\n"
    "        50         1 1.0\n"
    "    -1\n";

Mesh read_text(std::string_view text, Notes* notes = nullptr) {
  return read_mesh(std::as_bytes(std::span(text)), {.format = "unv", .name = "m.unv", .notes = notes});
}

std::string written(const Mesh& mesh, Notes* notes = nullptr) {
  return write_mesh_to_memory(mesh, "unv", "m.unv", notes).files.front().bytes;
}

const EntitySet& set_of(const Mesh& mesh, std::string_view name, Association association) {
  const auto found = std::find_if(mesh.sets.begin(), mesh.sets.end(), [&](const EntitySet& set) {
    return set.name == name && set.association == association;
  });
  EXPECT_NE(found, mesh.sets.end()) << name;
  return *found;
}

/// The numbers of a set's members.
std::vector<std::int64_t> numbers_of(const Mesh& mesh, std::string_view name, Association association) {
  std::vector<std::int64_t> result;
  for (const Index member : set_of(mesh, name, association).members) {
    result.push_back(association == Association::vertices ? mesh.vertex_ids[member] : mesh.cell_ids[member]);
  }
  return result;
}

/// The lines of a dataset between its number and its end.
std::string dataset_of(const std::string& text, int number) {
  std::string head = std::to_string(number);
  head = std::string(6 - head.size(), ' ').append(head).append("\n");
  const std::size_t begin = text.find("    -1\n" + head) + 7 + head.size();
  return text.substr(begin, text.find("    -1\n", begin) - begin);
}

TEST(Unv, ReadsNodesElementsGroupsAndResults) {
  Notes notes;
  const Mesh mesh = read_text(kFile, &notes);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_THAT(mesh.vertex_ids, ElementsAre(10, 20, 30, 40, 50));
  EXPECT_EQ(mesh.points[3], (Point{0, 0, 0.1}));
  EXPECT_THAT(mesh.cell_ids, ElementsAre(1, 2, 5, 7, 8));
  EXPECT_THAT(mesh.cells.shapes,
              ElementsAre(Shape::tetrahedron, Shape::tetrahedron, Shape::triangle, Shape::line, Shape::line));
  EXPECT_THAT(mesh.cells[1], ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(find_array(mesh, "label", Association::cells)->values),
            (std::vector<std::int32_t>{3, 3, 1, 2, 2}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(find_array(mesh, "material", Association::cells)->values),
            (std::vector<std::int32_t>{4, 5, 4, 4, 4}));
  EXPECT_THAT(set_of(mesh, "both kinds", Association::vertices).members, ElementsAre(4, 0));
  EXPECT_THAT(set_of(mesh, "both kinds", Association::cells).members, ElementsAre(1));
  EXPECT_THAT(set_of(mesh, "skin", Association::cells).members, ElementsAre(2, 0));
  const DataArray* const displacement = find_array(mesh, "displacement", Association::vertices);
  ASSERT_NE(displacement, nullptr);
  EXPECT_EQ(displacement->components, 3);
  EXPECT_THAT(displacement->indices, ElementsAre(4, 0));
  EXPECT_EQ(std::get<std::vector<double>>(displacement->values),
            (std::vector<double>{0.5, 0, 1, 0.1, 1.23456e-07, 0}));
}

TEST(Unv, WholeNumbersLeaveABlankInTenColumns) {
  EXPECT_TRUE(unv::fits_columns(999'999'999));
  EXPECT_FALSE(unv::fits_columns(1'000'000'000));
  EXPECT_TRUE(unv::fits_columns(-99'999'999));
  EXPECT_FALSE(unv::fits_columns(-100'000'000));
}

/// kFile as it is written: members of a group are written nodes first.
std::string as_written() {
  return with(std::string(kFile),
              "         7        50         0         0         8         2         0         0\n"
              "         7        10         0         0         8         9         0         0\n"
              "         3         4         0         0\n",
              "         7        50         0         0         7        10         0         0\n"
              "         8         2         0         0         3         4         0         0\n"
              "         8         9         0         0\n");
}

TEST(Unv, WritesWhatItRead) {
  const std::string expected = as_written();
  EXPECT_EQ(written(read_text(kFile)), expected);
  std::string crlf = expected;
  for (std::size_t at = 0; (at = crlf.find('\n', at)) != std::string::npos; at += 2) crlf.insert(at, 1, '\r');
  EXPECT_EQ(written(read_text(crlf)), crlf);
}

TEST(Unv, RenumbersAllThatNamesNodesAndElements) {
  Mesh mesh = read_text(kFile);
  // the nodes 10 … 50 become 50 … 10, the tetrahedra 1 and 2 and the lines 7 and 8 change places
  apply_reordering(mesh, Permutation::from_old_to_new({4, 3, 2, 1, 0}),
                   Permutation::from_old_to_new({1, 0, 2, 4, 3}));
  const std::string text = written(mesh);
  EXPECT_EQ(dataset_of(text, 2412),
            "         1       111         3         5         7         4\n"
            "        40        30        20        10\n"
            "         2       111         3         4         7         4\n"
            "        50        40        30        20\n"
            "         5        41         1         4         2         3\n"
            "        50        40        30\n"
            "         7        11         2         4         7         2\n"
            "        40        30\n"
            "         8        21         2         4         7         2\n"
            "        30         1         1\n"
            "        50        40\n"
            "         9       122         2         4         7         3\n"
            "        50        30        10\n");
  EXPECT_THAT(dataset_of(text, 2411),
              HasSubstr("        30         1         2         5\n"
                        "   0.0000000000000000D+00   1.0000000000000000D+00   0.0000000000000000D+00\n"));
  EXPECT_THAT(dataset_of(text, 2467),
              HasSubstr("both kinds\n"
                        "         7        10         0         0         7        50         0         0\n"
                        "         8         1         0         0         3         4         0         0\n"
                        "         8         9         0         0\n"));
  EXPECT_THAT(
      dataset_of(text, 2467),
      HasSubstr("skin\n         8         5         0         0         8         2         0         0\n"));
  EXPECT_THAT(dataset_of(text, 55), HasSubstr("        10\n  5.00000E-01  0.00000E+00  1.00000E+00\n"
                                              "        50\n  1.00000E-01  1.23456E-07  0.00000E+00\n"));
}

TEST(Unv, MovesLinesAndKeepsNumbers) {
  Mesh mesh = read_text(kFile);
  apply_reordering(mesh, Permutation::from_old_to_new({4, 3, 2, 1, 0}),
                   Permutation::from_old_to_new({1, 0, 2, 4, 3}), Ids::keep);
  const Mesh back = read_text(written(mesh));
  EXPECT_THAT(back.vertex_ids, ElementsAre(50, 40, 30, 20, 10));
  EXPECT_THAT(back.cell_ids, ElementsAre(2, 1, 5, 8, 7));
  EXPECT_THAT(numbers_of(back, "both kinds", Association::vertices), ElementsAre(50, 10));
  EXPECT_THAT(numbers_of(back, "skin", Association::cells), ElementsAre(5, 1));
  EXPECT_THAT(dataset_of(written(mesh), 2412), HasSubstr("        10        30        50\n"));
}

TEST(Unv, KeepsNumbersWhereADatasetMayNameThem) {
  Notes notes;
  Mesh mesh = read_text(std::string(kFile).append(kLoads), &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("dataset 790 (line 66)")));
  apply_reordering(mesh, Permutation::from_old_to_new({4, 3, 2, 1, 0}),
                   Permutation::identity(mesh.cell_count()));
  const std::string text = written(mesh);
  EXPECT_TRUE(text.ends_with(kLoads));
  EXPECT_THAT(read_text(text).vertex_ids, ElementsAre(50, 40, 30, 20, 10));
  std::reverse(mesh.vertex_ids.begin(), mesh.vertex_ids.end());
  EXPECT_THROW((void)written(mesh), InputError);
}

TEST(Unv, KeepsResultsOnNodesOfElements) {
  std::string text(kFile);
  text = with(text, "    55\ndisplacement", "    57\ndisplacement");
  Notes notes;
  const Mesh mesh = read_text(text, &notes);
  EXPECT_EQ(find_array(mesh, "displacement", Association::vertices), nullptr);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("dataset 57 (line 46)")));
  EXPECT_EQ(dataset_of(written(mesh), 57), dataset_of(text, 57));
}

TEST(Unv, NamesStepsOfResults) {
  const std::string once = dataset_of(std::string(kFile), 55);
  const std::string again = "    -1\n    55\n" + once + "    -1\n";
  const Mesh mesh = read_text(std::string(kFile).append(again));
  EXPECT_NE(find_array(mesh, "displacement step 1", Association::vertices), nullptr);
  EXPECT_NE(find_array(mesh, "displacement step 2", Association::vertices), nullptr);
  EXPECT_TRUE(written(mesh).ends_with(again));
}

TEST(Unv, StepsStayInTheirPlacesWhereAHeaderIsMadeAnew) {
  const std::string again = "    -1\n    55\n" + dataset_of(std::string(kFile), 55) + "    -1\n";
  // the first dataset of results declares whole numbers, but has real ones
  const std::string text =
      with(std::string(kFile), "         8         2         3\n", "         8         1         3\n") +
      again;
  const Mesh mesh = read_text(text);
  ASSERT_NE(find_array(mesh, "displacement step 2", Association::vertices), nullptr);
  test::expect_same(read_text(written(mesh)), mesh);
}

TEST(Unv, WholeNumbersThatFillTheirColumnsAreReal) {
  std::string text =
      with(std::string(kFile), "         8         2         3\n", "         8         1         3\n");
  text = with(text, "  5.00000E-01  0.00000E+00  1.00000E+00\n", "2147483647         0         1\n");
  text = with(text, "  1.00000E-01  1.23456E-07  0.00000E+00\n", "         3 -99999999         2\n");
  const Mesh mesh = read_text(text);
  test::expect_same(read_text(written(mesh)), mesh);
}

/// `as_written` with a text after the fields of every line, after each -1 and each number of a dataset, and
/// with lines before, between and after datasets.
std::string with_texts() {
  std::string text = as_written();
  std::string result = "made by hand\n\n";
  int number = 0;
  bool is_inside = false;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string line = text.substr(0, end);
    text.erase(0, end + 1);
    const bool has_number = line.find_first_not_of(" 0123456789.DE+-") == std::string::npos;
    result += line;
    if (has_number) result += fmt::format("  % text {}", ++number);
    result += '\n';
    if (line != "    -1") continue;
    is_inside = !is_inside;
    if (!is_inside) result += "between the datasets\n";
  }
  return result;
}

TEST(Unv, FieldsEndWhereTheFormatSays) {
  const std::string text = with_texts();
  Notes notes;
  Mesh mesh = read_text(text, &notes);
  EXPECT_THAT(notes, IsEmpty());
  const Mesh plain = read_text(kFile);
  EXPECT_EQ(mesh.points, plain.points);
  EXPECT_EQ(mesh.cells, plain.cells);
  EXPECT_EQ(mesh.data, plain.data);
  EXPECT_EQ(mesh.sets.size(), plain.sets.size());
  EXPECT_EQ(written(mesh), text);
  EXPECT_THAT(mesh.format_metadata->contents(), Contains("texts after the numbers of a line"));
  EXPECT_THAT(mesh.format_metadata->contents(), Contains("lines between datasets"));
  // texts follow their nodes, elements and values
  apply_reordering(mesh, Permutation::from_old_to_new({4, 3, 2, 1, 0}),
                   Permutation::from_old_to_new({1, 0, 2, 3, 4}));
  const std::string moved = written(mesh);
  const auto text_of = [](const std::string& file, const std::string& line) {
    const std::size_t begin = file.find('\n' + line) + 1 + line.size();
    return file.substr(begin, file.find('\n', begin) - begin);
  };
  for (const std::string line :
       {"   1.0000000000000000D+00   1.0000000000000000D+00   1.0000000000000000D+00",
        "  5.00000E-01  0.00000E+00  1.00000E+00"}) {
    EXPECT_THAT(text_of(moved, line), HasSubstr("% text")) << line;
    EXPECT_EQ(text_of(moved, line), text_of(text, line)) << line;
  }
  EXPECT_EQ(text_of(moved, "         1       111         3         5         7         4"),
            text_of(text, "         2       111         3         5         7         4"));
  EXPECT_EQ(read_text(moved).points, mesh.points);
}

TEST(Unv, NumbersThatFillTheirFieldsNeedNoBlank) {
  std::string text = with(std::string(kFile), "        50         1         1        11",
                          "        50         1-1111111111234567890");
  text = with(text, "  5.00000E-01  0.00000E+00  1.00000E+00", "  5.00000E-01-1.00000E+100-2.50000E+00");
  const Mesh mesh = read_text(text);
  EXPECT_EQ(mesh.points[4], (Point{1, 1, 1}));
  EXPECT_THAT(std::get<std::vector<double>>(find_array(mesh, "displacement", Association::vertices)->values),
              ElementsAre(0.5, -1e100, -2.5, 0.1, 1.23456e-07, 0));
}

TEST(Unv, ReadsOlderDatasets) {
  const std::string text =
      "    -1\n    15\n"
      "         1         0         0         1  0.00000E+00  0.00000E+00  0.00000E+00\n"
      "         2         0         0         1  1.00000E+00  0.00000E+00  0.00000E+00\n"
      "         3         0         0         1  1.00000E+00  1.25000E-01  0.00000E+00\n"
      "    -1\n    -1\n   780\n"
      "         1        91         1         6         1         4         7         3\n"
      "         1         2         3\n"
      "    -1\n    -1\n   752\n"
      "         1         0         0         0         0         3\n"
      "old\n"
      "         7         1         7         3         8         1\n"
      "    -1\n";
  Mesh mesh = read_text(text);
  EXPECT_EQ(mesh.points[2], (Point{1, 0.125, 0}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(find_array(mesh, "label", Association::cells)->values),
            std::vector<std::int32_t>{6});
  EXPECT_THAT(set_of(mesh, "old", Association::vertices).members, ElementsAre(0, 2));
  EXPECT_EQ(written(mesh), text);
  // coordinates with more than six digits are written with all they need
  mesh.points[2][1] = 0.1 + 1e-9;
  EXPECT_EQ(read_text(written(mesh)).points, mesh.points);
}

TEST(Unv, ReadsNumbersOfFortran) {
  const std::string text = with(with(std::string(kFile), "1.0000000000000001D-01", "1.0000000000000000-101"),
                                "   1.0000000000000000D+00   1.0000000000000000D+00", "  +1.5d0 1");
  const Mesh mesh = read_text(text);
  EXPECT_EQ(mesh.points[3][2], 1e-101);
  EXPECT_EQ(mesh.points[4], (Point{1.5, 1, 1}));
  EXPECT_EQ(read_text(written(mesh)).points, mesh.points);
}

TEST(Unv, KeepsNumbersFromZero) {
  const std::string text =
      "    -1\n  2411\n"
      "         0         1         1        11\n"
      "   0.0000000000000000E+00   0.0000000000000000E+00   0.0000000000000000E+00\n"
      "         1         1         1        11\n"
      "   1.0000000000000000E+00   0.0000000000000000E+00   0.0000000000000000E+00\n"
      "    -1\n    -1\n  2412\n"
      "         0        21         1         0         7         2\n"
      "         0         0         0\n"
      "         1         0\n"
      "    -1\n";
  Mesh mesh = read_text(text);
  EXPECT_THAT(mesh.vertex_ids, ElementsAre(0, 1));
  Notes notes;
  EXPECT_EQ(written(mesh, &notes), text);
  EXPECT_THAT(notes, IsEmpty());
  apply_reordering(mesh, Permutation::from_old_to_new({1, 0}), Permutation::identity(1));
  EXPECT_THAT(dataset_of(written(mesh), 2412),
              HasSubstr("         0         0         0\n         0         1\n"));
}

TEST(Unv, SkipsBinaryData) {
  std::string binary =
      "    -1\n    58b     1     2           1          10        0         0         0           0\nline\n";
  binary += "\n    -1\n\xff\x00";
  binary += std::string("\0\n    -1\n", 9);
  const Mesh mesh = read_text(binary + std::string(kFile));
  EXPECT_EQ(mesh.vertex_count(), 5);
  EXPECT_TRUE(written(mesh).starts_with(binary));
}

/// The corners of each edge of a second-order cell, in VTK's order of the middle nodes.
std::vector<std::pair<int, int>> edges_of(Shape shape) {
  switch (shape) {
    case Shape::line:
      return {{0, 1}};
    case Shape::triangle:
      return {{0, 1}, {1, 2}, {2, 0}};
    case Shape::quad:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    case Shape::tetrahedron:
      return {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    case Shape::wedge:
      return {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
    default:
      return {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  }
}

TEST(Unv, PutsMiddleNodesBetweenTheirCorners) {
  // first a ring: corners, with middle nodes between them. In volumes then the middle nodes of the edges that
  // lead up from its corners, and the other nodes
  for (const auto& [shape, nodes] : test::quadratic_types()) {
    const unv::ElementKind kind{shape, nodes};
    if (unv::type_of(kind) == 0) continue;
    SCOPED_TRACE(type_name(shape, nodes));
    const auto order = unv::file_order(kind);
    ASSERT_EQ(order.size(), static_cast<std::size_t>(nodes));
    const int first_middle = corners(shape, nodes);
    const auto edges = edges_of(shape);
    const auto edge = [&](std::size_t k) {
      return edges.at(static_cast<std::size_t>(order[k] - first_middle));
    };
    const std::size_t ring = shape == Shape::line                                 ? 3
                             : shape == Shape::quad || shape == Shape::hexahedron ? 8
                                                                                  : 6;
    for (std::size_t k = 1; k < ring; k += 2) {
      EXPECT_EQ(edge(k), (std::pair{order[k - 1], order[(k + 1) % ring]}));
    }
    if (dimension(shape) < 3) continue;
    const std::size_t above = ring + ring / 2;  // end of those middle nodes
    for (std::size_t k = ring; k < above; ++k) {
      const std::size_t end = shape == Shape::tetrahedron ? above : above + 2 * (k - ring);
      EXPECT_EQ(edge(k), (std::pair{order[2 * (k - ring)], order[end]}));
    }
    const std::size_t rest = order.size() - above;
    for (std::size_t k = 1; k < rest; k += 2) {
      EXPECT_EQ(edge(above + k), (std::pair{order[above + k - 1], order[above + (k + 1) % rest]}));
    }
  }
  EXPECT_EQ(unv::kind_of(74, 3), unv::kind_of(71, 3));
  EXPECT_FALSE(unv::kind_of(43, 9));
  EXPECT_FALSE(unv::kind_of(122, 3));
}

TEST(Unv, WritesMeshesOfOtherFormats) {
  Mesh mesh = test::tetrahedral_bar(2);
  Notes notes;
  const std::string text = written(mesh, &notes);
  EXPECT_THAT(notes, Contains(HasSubstr("rounded to the 13 digits")));
  const Mesh back = read_text(text);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
  EXPECT_EQ(back.sets.size(), mesh.sets.size());
  const DataArray* const stress = find_array(back, "stress", Association::cells);
  ASSERT_NE(stress, nullptr);
  EXPECT_EQ(stress->components, 3);
  EXPECT_EQ(row_count(*stress), mesh.cell_count());
  EXPECT_EQ(written(back), text);
}

TEST(Unv, ShortensNamesOfGroups) {
  Mesh mesh = test::triangles_and_line(2);
  const std::string longest(40, 'x');
  mesh.sets = {{longest + "1", Association::cells, {0}},
               {longest + "2", Association::cells, {1}},
               {"two words", Association::vertices, {0}},
               {"empty", Association::vertices, {}}};
  Notes notes;
  const Mesh back = read_text(written(mesh, &notes));
  ASSERT_EQ(back.sets.size(), 3U);
  EXPECT_EQ(back.sets[0].name, longest);
  EXPECT_EQ(back.sets[1].name, longest.substr(2) + "_2");
  EXPECT_EQ(back.sets[2].name, "two_words");
  EXPECT_EQ(notes.size(), 4U);
}

TEST(Unv, AddsSetsAndArraysToItsFile) {
  Mesh mesh = read_text(kFile);
  mesh.sets.push_back({"new", Association::vertices, {3}});
  mesh.data.push_back({"count", Association::cells, 1, std::vector<std::int32_t>{1, 2, 3, 4, 5}, {}, {}});
  std::erase_if(mesh.sets, [](const EntitySet& set) { return set.name == "skin"; });
  const Mesh back = read_text(written(mesh));
  EXPECT_THAT(numbers_of(back, "new", Association::vertices), ElementsAre(40));
  ASSERT_NE(find_array(back, "count", Association::cells), nullptr);
  EXPECT_EQ(find_array(back, "count", Association::cells)->values,
            find_array(mesh, "count", Association::cells)->values);
  EXPECT_EQ(back.sets.size(), 3U);
}

TEST(Unv, IsAPlainFileAfterCellsWereLeftOut) {
  Mesh mesh = read_text(std::string(kFile).append(kLoads));
  (void)keep_cells(mesh, {.dimension = 3});
  const std::string text = written(mesh);
  EXPECT_EQ(text.find("   790"), std::string::npos);
  EXPECT_EQ(read_text(text).cell_count(), 2);
}

TEST(Unv, NamesWhatOthersLose) {
  const Mesh mesh = read_text(kFile);
  EXPECT_THAT(mesh.format_metadata->contents(),
              ElementsAre("members of the group 'both kinds' that are neither nodes nor cells",
                          "the types of elements 11, 41", "elements of the types 122", "dataset 164"));
}

TEST(Unv, IsKnownByItsFirstBytes) { EXPECT_EQ(format_of_bytes(kFile)->name, "UNV"); }

TEST(Unv, NotesMembersThatDoNotExist) {
  Notes notes;
  const std::string text =
      with(std::string(kFile), "         8         5         0         0         8         1",
           "         8         5         0         0         7        11");
  const Mesh mesh = read_text(text, &notes);
  EXPECT_THAT(
      notes,
      ElementsAre(HasSubstr(
          "m.unv:42: the group 'skin' is read without a node or element that the file does not have")));
  EXPECT_THAT(set_of(mesh, "skin", Association::cells).members, ElementsAre(2));
}

TEST(Unv, RefusesBrokenFiles) {
  const auto changed = [](std::string_view old, std::string_view fresh) {
    return with(std::string(kFile), old, fresh);
  };
  const std::string local =
      "    -1\n  2420\n         1\npart\n         1         0         0\nturned\n"
      "    0.0 1.0 0.0\n    1.0 0.0 0.0\n    0.0 0.0 1.0\n    0.0 0.0 0.0\n    -1\n";
  test::expect_broken(
      "m.unv",
      {{"no dataset", "1 2 3\n", ":1: expected a line of -1, which begins a dataset, found '1 2 3'"},
       {"only text", "made by hand\n\n",
        ":1: expected a line of -1, which begins a dataset, found 'made by hand'"},
       {"no line of -1", changed("    -1\n    -1\n  2412", "    -1\n  2412"),
        ":19: expected a line of -1, which begins a dataset, found '2412'; the file may be damaged"},
       {"no number", "    -1\n", "the file ends before the number of a dataset"},
       {"a word", "    -1\nnodes\n", ":2: the number of a dataset is 'nodes'"},
       {"two lines of -1", "    -1\n    -1\n", ":2: the number of a dataset is '-1'"},
       {"no nodes", "    -1\n   151\n    -1\n", "has no nodes"},
       {"no elements", std::string(kFile.substr(0, kFile.find("    -1\n  2412"))), "has no elements"},
       {"open dataset", std::string(kFile.substr(0, kFile.size() - 7)),
        "the dataset 164 of line 61 has no line of -1 at its end"},
       {"no coordinate", changed("1.0000000000000001D-01", ""), ":15: the line ends before a coordinate"},
       {"fourth coordinate", changed("1.0000000000000001D-01", "1 1"), ":15: the node has too many numbers"},
       {"a word for a number", changed("1.0000000000000001D-01", "one"), ":15: a coordinate is 'one'"},
       {"not finite", changed("1.0000000000000001D-01", "nan"), ":15: a coordinate is not finite"},
       {"huge", changed("1.0000000000000001D-01", "1D999"), ":15: a coordinate is 1D999"},
       {"node twice", changed("        40         1", "        30         1"), ":14: node 30 is given twice"},
       {"number below 0", changed("        40         1", "        -3         1"),
        ":14: the number of a node is -3"},
       {"element twice", changed("         2       111", "         1       111"),
        ":23: element 1 is given twice"},
       {"no such node",
        changed("        20        30        40        50", "        20        30        40        51"),
        ":24: a node of the element is 51, which no dataset of nodes has"},
       {"too few nodes",
        changed("        20        30        40        50", "        20        30        40"),
        ":25: the element has too many numbers"},
       {"too many nodes",
        changed("        20        30        40        50", "        20        30        40  50 10"),
        ":24: the element has too many numbers"},
       {"huge count",
        changed("         4         7         3\n        10        30        50",
                "         4         7 999999999\n        10        30        50"),
        ":33: the number of its nodes is 999999999, but only"},
       {"huge group", changed("         0         5\nboth", " 0 999999999\nboth"),
        ":37: the number of members is 999999999, but only"},
       {"cut group", changed("         8         9         0         0\n         3", "\n         3"),
        ":42: the group has too many numbers"},
       {"value", changed("1.23456E-07", "x"), ": a value is 'x'"},
       {"local system", local + std::string(kFile), "nodes have coordinates in the coordinate system 1"}});
}

TEST(Unv, NoticesATruncatedMesh) {
  // no datasets after the mesh: each cut is within the mesh
  const std::size_t end = kFile.find("\n    -1\n  2467");
  test::expect_truncation_is_noticed("m.unv", kFile.substr(0, end));
}

}  // namespace
}  // namespace meshorder
