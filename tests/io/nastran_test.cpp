// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/nastran/nastran.hpp"

#include "io/format.hpp"
#include "io/labels.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using nastran::real_of;
using nastran::real_text;
using test::expect_order_and_back_to;
using test::TemporaryFolder;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// two hexahedra, a shell without its own property, a bar with a node for its orientation; nodes in small,
// large and free fields
constexpr std::string_view kBulk =
    "$ made by hand\n"
    "SOL 101\n"
    "CEND\n"
    "TITLE = 1, 2\n"
    "SPC = 4\n"
    "BEGIN BULK\n"
    "PARAM,GRDPNT,5\n"
    "GRID           1              0.      0.      0.\n"
    "GRID    2               1.      0.      0.      3       123456\n"
    "GRID*                  3                              1.              1.\n"
    "*                     0.\n"
    "GRID,4,,0.,+1.,.0\n"
    "grid*,5,,0.,0.\n"
    "*,1.0D+0\n"
    "GRID,6,,1.+0,0.,10.-1   $ six\n"
    "GRID,7,,1.,1.,1.\n"
    "$ between\n"
    "GRID,8,,0.,1.,1.\n"
    "GRID\t9\t\t0.\t0.\t2.\n"
    "GRID,10,,1.,0.,2.\n"
    "GRID,11,,1.,1.,2.\n"
    "GRID,12,,0.,1.,2.\n"
    "GRID,99,,5.,5.,5.\n"
    "CHEXA          1       5       1       2       3       4       5       6+A1\n"
    "+A1            7       8\n"
    "CHEXA,2,5,5,6,7,8,9,10\n"
    ",11,12\n"
    "PSOLID  5       1\n"
    "CQUAD4  11              1       4       3       2\n"
    "CBAR    20      7       2       99      1\n"
    "SPOINT  50\n"
    "CELAS2  30      1000.   1       1       50\n"
    "RBE2    31      9       123     10      11      12\n"
    "RBE3    32              99      123     1.0     123     1       2\n"
    "        3       0.5     12      4       UM      1       1\n"
    "SPC1    4       123456  1       THRU    4\n"
    "SPC1    4       1       9       10\n"
    "FORCE   1       12              10.     0.      0.      1.\n"
    "PLOAD4  2       1       1.5                             1       3\n"
    "PLOAD4  2       1       2.5                             THRU    2\n"
    "MPC     6       1       1       1.      2       1       -1.\n"
    "                3       2       5.      4       2       6.\n"
    "TEMP    7       1       20.     9       30.     99      40.\n"
    "$ set: top and others\n"
    "SET3    1       GRID    9       10      11      12\n"
    "ENDDATA\n"
    "1 2 3\n";

/// Reads a deck, moves its nodes and elements to these places, and returns the written deck.
std::string moved(std::string_view deck, const std::vector<Index>& vertices, const std::vector<Index>& cells,
                  Ids ids = Ids::renumber) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.bdf", deck));
  apply_reordering(mesh, Permutation::from_old_to_new(vertices), Permutation::from_old_to_new(cells), ids);
  write_mesh(mesh, folder.path() / "b.bdf");
  return test::content_of(folder.path() / "b.bdf");
}

TEST(NastranField, ReadsRealNumbersInAllSpellings) {
  EXPECT_EQ(real_of("1.5-3"), 1.5e-3);
  EXPECT_EQ(real_of("-.5+2"), -50.0);
  EXPECT_EQ(real_of("1.5D-3"), 1.5e-3);
  EXPECT_EQ(real_of("+7.E+1"), 70.0);
  EXPECT_EQ(real_of("7"), 7.0);
  for (const std::string_view text : {"", "x", "1.5x", "nan", "inf", "1.+999", "--1", "-", "1.5-", "."}) {
    EXPECT_EQ(real_of(text), std::nullopt) << text;
  }
}

TEST(NastranField, WritesRealNumbersInSixteenCharacters) {
  EXPECT_EQ(real_text(0.0).text, "0.");
  EXPECT_EQ(real_text(0.5).text, ".5");
  EXPECT_EQ(real_text(-1e-20).text, "-1.-20");
  EXPECT_EQ(real_text(3e100).text, "3.+100");
  for (const double value : {0.1, -2.5, 123456789.5, 1e-300, -1.0 / 3, 0.61885170021204, std::sqrt(2.0),
                             -std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min(),
                             -1.2345678901234567e-123}) {
    const auto [text, is_rounded] = real_text(value);
    EXPECT_LE(text.size(), 16U);
    EXPECT_NE(text.find('.'), std::string::npos) << text;
    const auto back = real_of(text);
    ASSERT_TRUE(back) << text;
    EXPECT_EQ(*back != value, is_rounded) << text;
    EXPECT_NEAR(*back / value, 1, 1e-8) << text;
  }
  EXPECT_TRUE(real_text(-1.0 / 3).is_rounded);
}

/// The cards of a part of the text, and whether each is an orphan.
std::vector<std::pair<std::string, bool>> cards_of(std::string_view text, nastran::Piece part) {
  std::vector<std::pair<std::string, bool>> result;
  nastran::Cards cards(text, part);
  while (cards.next()) result.emplace_back(cards.lines(), cards.is_orphan());
  return result;
}

TEST(NastranCard, IsFoundHoweverTheTextIsDivided) {
  const std::string unix_lines =
      "+,1\nGRID,1,,0.,\n$ within\n+,0.,0.\n\n$ between\n  GRID,2\nGRID*   3\n*       0.\n      \nSPC,1\n\n";
  std::string dos_lines = unix_lines;
  for (std::size_t at = 0; (at = dos_lines.find('\n', at)) != std::string::npos; at += 2) {
    dos_lines.insert(at, 1, '\r');
  }
  std::string old_lines = unix_lines;
  std::replace(old_lines.begin(), old_lines.end(), '\n', '\r');
  for (const std::string& text : {unix_lines, dos_lines, old_lines, unix_lines + "GRID,4"}) {
    const nastran::Piece whole{0, text.size()};
    const auto expected = cards_of(text, whole);
    EXPECT_GE(expected.size(), 5U);
    for (std::size_t bytes = 1; bytes <= text.size(); ++bytes) {
      std::vector<std::pair<std::string, bool>> found;
      std::size_t begin = 0;
      for (const nastran::Piece part : nastran::parts_of_cards(text, whole, bytes)) {
        EXPECT_EQ(part.begin, begin);
        for (const auto& card : cards_of(text, part)) found.push_back(card);
        begin = part.end;
      }
      EXPECT_EQ(begin, text.size());
      EXPECT_EQ(found, expected) << bytes;
    }
  }
}

/// A deck of as many nodes in a row and of bars between them, with other cards among them.
std::string deck_of_row(int nodes) {
  std::string deck = "CEND\nBEGIN BULK\n";
  for (int k = 1; k <= nodes; ++k) {
    deck += fmt::format("GRID    {:8}        {:8.1f}{:8.1f}{:8.1f}\n", k, k / 8.0, 0.5, 1.0);
    if (k % 1000 == 0) deck += fmt::format("$ node\nSPC     {:8}{:8}{:8}\n", 1, k, 123);
  }
  for (int k = 1; k < nodes; ++k) {
    deck += fmt::format("CROD    {:8}{:8}{:8}{:8}\n", k, 1 + k % 2, k, k + 1);
    if (k == nodes / 2) deck += fmt::format("$\n{}", std::string(5000, '$') + "\n");
  }
  return deck + "ENDDATA\n";
}

TEST(Nastran, OrdersManyCardsAndBack) { expect_order_and_back_to("a.bdf", deck_of_row(20000)); }

TEST(Nastran, FindsTheFirstFaultOfManyCards) {
  const TemporaryFolder folder;
  const std::string deck = deck_of_row(20000);
  // lines 1 and 2 are before the nodes, and two lines follow each thousandth node
  const std::string fault = with(deck, "GRID       19990", "GRID       1999x");
  EXPECT_THAT(test::read_error(folder.file("a.bdf", fault)),
              HasSubstr("a.bdf:20030: the number of a node is '1999x'"));
  EXPECT_THAT(test::read_error(folder.file("a.bdf", with(fault, "GRID       15000", "GRID       14999"))),
              HasSubstr("a.bdf:15030: node 14999 is given twice"));
}

TEST(Nastran, ReadsNodesElementsPropertiesAndSets) {
  const TemporaryFolder folder;
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("a.bdf", kBulk), {.notes = &notes});
  EXPECT_THAT(notes, IsEmpty());
  ASSERT_EQ(mesh.vertex_count(), 13);
  EXPECT_EQ(mesh.points[2], (Point{1, 1, 0}));
  EXPECT_EQ(mesh.points[4], (Point{0, 0, 1}));
  EXPECT_EQ(mesh.points[5], (Point{1, 0, 1}));
  EXPECT_EQ(mesh.points[8], (Point{0, 0, 2}));
  ASSERT_EQ(mesh.cell_count(), 4);
  EXPECT_THAT(mesh.cells[1], ElementsAre(4, 5, 6, 7, 8, 9, 10, 11));
  EXPECT_THAT(mesh.cells[3], ElementsAre(1, 12));
  EXPECT_THAT(mesh.cell_ids, ElementsAre(1, 2, 11, 20));
  EXPECT_THAT(labels_of(mesh, Association::cells).values, ElementsAre(5, 5, 11, 7));
  EXPECT_THAT(mesh.cell_blocks, ElementsAre(0, 2));  // another card is between the elements
  ASSERT_EQ(mesh.sets.size(), 1U);
  EXPECT_EQ(mesh.sets[0].name, "top and others");
  EXPECT_THAT(mesh.sets[0].members, ElementsAre(8, 9, 10, 11));
}

TEST(Nastran, WritesWhatItReadWhereNothingMoves) {
  const std::vector<Index> vertices{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  std::string expected(kBulk);
  const std::string tabs = "GRID\t9\t\t0.\t0.\t2.\n";
  expected.replace(expected.find(tabs), tabs.size(), "GRID    9               0.      0.      2.\n");
  EXPECT_EQ(moved(kBulk, vertices, {0, 1, 2, 3}), expected);
}

TEST(Nastran, RenumbersAllReferences) {
  // swaps nodes 1 and 2, nodes 4 and 9, and the hexahedra
  const std::string text = moved(kBulk, {1, 0, 2, 8, 4, 5, 6, 7, 3, 9, 10, 11, 12}, {1, 0, 2, 3});
  EXPECT_THAT(text, HasSubstr("BEGIN BULK\n"
                              "PARAM,GRDPNT,5\n"
                              "GRID    1               1.      0.      0.      3       123456\n"
                              "GRID           2              0.      0.      0.\n"));
  EXPECT_THAT(text, HasSubstr("*                     0.\n"
                              "GRID    4               0.      0.      2.\n"
                              "grid*,5,,"));
  EXPECT_THAT(text, HasSubstr("CHEXA,1,5,5,6,7,8,4,10\n"
                              ",11,12\n"
                              "CHEXA          2       5       2       1       3       9       5       6+A1\n"
                              "+A1            7       8\n"));
  EXPECT_THAT(text, HasSubstr("CQUAD4  11              2       9       3       1\n"
                              "CBAR    20      7       1       99      2\n"
                              "SPOINT  50\n"
                              "CELAS2  30      1000.   2       1       50\n"
                              "RBE2    31      4       123     10      11      12\n"
                              "RBE3    32              99      123     1.0     123     2       1\n"
                              "        3       0.5     12      9       UM      2       1\n"
                              "SPC1           4  123456       1       2       3       9\n"
                              "SPC1    4       1       4       10\n"
                              "FORCE   1       12 "));
  EXPECT_THAT(text, HasSubstr("PLOAD4  2       2       1.5                             2       3\n"
                              "PLOAD4  2       1       2.5                             THRU    2\n"
                              "MPC     6       2       1       1.      1       1       -1.\n"
                              "                3       2       5.      9       2       6.\n"
                              "TEMP    7       2       20.     4       30.     99      40.\n"
                              "$ set: top and others\n"
                              "SET3    1       GRID    4       10      11      12\n"
                              "ENDDATA\n"
                              "1 2 3\n"));
}

TEST(Nastran, MovesLinesWithTheirNumbersWhereIdsAreKept) {
  const std::string text = moved(kBulk, {1, 0, 2, 8, 4, 5, 6, 7, 3, 9, 10, 11, 12}, {1, 0, 2, 3}, Ids::keep);
  EXPECT_THAT(text, HasSubstr("GRID    2               1.      0.      0.      3       123456\n"
                              "GRID           1              0.      0.      0.\n"));
  EXPECT_THAT(text, HasSubstr(std::string(kBulk.substr(kBulk.find("PSOLID")))));
}

TEST(Nastran, WritesARangeOfPressureAsOneCardForEachElement) {
  std::string deck(kBulk);
  const std::string range = "THRU    2\n";
  deck = with(deck, "PLOAD4  2       1       2.5", "PLOAD4  2       2       2.5");
  deck.replace(deck.find(range), range.size(), "THRU    11\n");
  const std::vector<Index> vertices{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  const std::string text = moved(deck, vertices, {1, 0, 2, 3});
  EXPECT_THAT(text, HasSubstr("PLOAD4  2       1       2.5"));
  EXPECT_THAT(text, HasSubstr("PLOAD4  2       11      2.5"));
  EXPECT_THAT(text, Not(HasSubstr("THRU    11")));
}

TEST(Nastran, KeepsNumbersWhereACardIsNotKnown) {
  const std::vector<std::pair<std::string, std::string>> changes{
      {"SPOINT  50\n", "CWELD,60,1,1\n"},
      {"SPC = 4\n", "SET 7 = 1000,\n 3\n"},
      {"SPC = 4\n", "SET 7 = 1 THRU 9000\n"},
      {"$ between\n", "$HMMOVE 4\n"},
      {"SPOINT  50\n", "SPC1,4,1,1,THRU,9,EXCEPT,3\n"},
      {"SPOINT  50\n", "PLOTEL,60,1000,1000,,61,1,2\n"},
      {"SPOINT  50\n", "BLSEG,60,1,THRU,4\n"},
      {"SPOINT  50\n", "RBE3,60,,1000,123,1.,123,1,THRU,+\n+,4\n"},
      {"SPC = 4\n", "GROUNDCHECK(GRID=3,SET=ALL) = YES\n"},
      {"SPC = 4\n", "PARAM,GRDPNT,3\n"},
  };
  const std::vector<Index> vertices{1, 0, 2, 8, 4, 5, 6, 7, 3, 9, 10, 11, 12};
  for (const auto& [old, fresh] : changes) {
    SCOPED_TRACE(fresh);
    const std::string deck = with(std::string(kBulk), old, fresh);
    const TemporaryFolder folder;
    Notes notes;
    (void)read_mesh(folder.file("a.bdf", deck), {.notes = &notes});
    EXPECT_THAT(notes, ElementsAre(HasSubstr("keep their numbers")));
    const std::string text = moved(deck, vertices, {1, 0, 2, 3});
    EXPECT_THAT(text, HasSubstr("GRID    2               1.      0.      0."));
    EXPECT_THAT(text, HasSubstr(deck.substr(deck.find("CELAS2"))));
  }
  for (const std::string_view fresh : {"CWELD,60,1000\n", "ECHOOFF\n", "SET1,5,1000\n"}) {
    const TemporaryFolder folder;
    Notes notes;
    (void)read_mesh(folder.file("a.bdf", with(std::string(kBulk), "SPOINT  50\n", fresh)), {.notes = &notes});
    EXPECT_THAT(notes, IsEmpty()) << fresh;
  }
}

TEST(Nastran, RenumbersPointsOfConvection) {
  const std::string deck = with(std::string(kBulk), "SPOINT  50\n",
                                "CONV,60,70,1,2,3,4\n"
                                "PCONV,70,9,,,,,,,+\n"
                                "+,,2\n");
  EXPECT_THAT(moved(deck, {1, 0, 2, 8, 4, 5, 6, 7, 3, 9, 10, 11, 12}, {1, 0, 2, 3}),
              HasSubstr("CONV,60,70,2,1,3,9\n"
                        "PCONV,70,9,,,,,,,+\n"
                        "+,,1\n"));
}

TEST(Nastran, TakesPropertiesOfBarsFromBaror) {
  const std::string deck =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n"
      "CBAR,7,,1,2\nCBAR,8,,2,3\nCBAR,9,5,3,1\n"
      "CBEAM,17,,1,2,0.,0.,1.\n"
      "BAROR,,1001,,,0.,0.,1.\n";
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.bdf", deck));
  EXPECT_THAT(labels_of(mesh, Association::cells).values, ElementsAre(1001, 1001, 5, 17));
  EXPECT_THAT(moved(deck, {2, 1, 0}, {1, 0, 2, 3}), HasSubstr("CBAR,7,,2,1\nCBAR,8,,3,2\nCBAR,9,5,1,3\n"));
}

TEST(Nastran, KeepsElementsThatHaveNoPropertyYet) {
  const std::string deck =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,1.,1.,0.\n"
      "CTRIA3,1,0,1,2,3\nCTRIA3,2,4,2,4,3\nCTRIA3,3,,2,4,3\n";
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.fem", deck));
  EXPECT_THAT(labels_of(mesh, Association::cells).values, ElementsAre(0, 4, 3));
  EXPECT_THAT(moved(deck, {0, 1, 2, 3}, {1, 0, 2}),
              HasSubstr("CTRIA3,1,4,2,4,3\nCTRIA3,2,0,1,2,3\nCTRIA3,3,,2,4,3\n"));
}

TEST(Nastran, DoesNotReadTheFirstColumnOfTheNameOfALine) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.bdf", with(std::string(kBulk), "6+A1\n", "6CA1\n")));
  EXPECT_EQ(mesh.vertex_count(), 13);
}

TEST(Nastran, TakesTabsForColumnsBeforeACommentWithAComma) {
  const TemporaryFolder folder;
  const Mesh mesh = read_mesh(folder.file("a.bdf",
                                          "GRID\t1\t\t0.\t2.\t0.\t$ the first, at 0, 2\n"
                                          "GRID\t2\t\t1.\t0.\t0.\n"
                                          "CROD\t1\t1\t1\t2\t$ one, of steel\n"));
  EXPECT_THAT(mesh.points, ElementsAre(Point{0, 2, 0}, Point{1, 0, 0}));
}

TEST(Nastran, ReadsBulkDataAloneAndIncludedFiles) {
  const TemporaryFolder folder;
  (void)folder.file("nodes.inc", "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.");
  Notes notes;
  const Mesh mesh =
      read_mesh(folder.file("a.nas", "include 'nodes.inc'\r\nCTRIA3,1,1,1,2,3\r\n"), {.notes = &notes});
  EXPECT_THAT(notes, ElementsAre(HasSubstr("included files are now part of the file: nodes.inc")));
  write_mesh(mesh, folder.path() / "b.nas");
  EXPECT_EQ(test::content_of(folder.path() / "b.nas"),
            "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\r\nCTRIA3,1,1,1,2,3\r\n");
}

TEST(Nastran, ReadsNamesOfIncludedFilesOverSeveralLines) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "a" / "long name");
  const std::string nodes = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n";
  (void)folder.file("a/b.dat", nodes);
  (void)folder.file("a/long name/c.dat", nodes);
  const auto nodes_of = [&](const std::string& include) {
    return read_mesh(folder.file("a.bdf", include + "CTRIA3,1,1,1,2,3\nENDDATA\n")).vertex_count();
  };
  EXPECT_EQ(nodes_of("INCLUDE 'a/\nb.dat'\n"), 3);
  EXPECT_EQ(nodes_of("INCLUDE 'a/\r\n   b.dat' $ the nodes\r\n"), 3);
  EXPECT_EQ(nodes_of("include \"a/\nlong name/\n  c.d\nat\"\n"), 3);
  EXPECT_EQ(nodes_of("INCLUDE='\na/b.dat\n'\n"), 3);

  (void)folder.file("b.bdf", "INCLUDE 'a/\nb.dat\n" + nodes);
  EXPECT_THAT(test::read_error(folder.path() / "b.bdf"),
              HasSubstr("b.bdf:1: the name of the included file has no quote at its end; add it"));
  (void)folder.file("a/c.bdf", "GRID,9,,0.,0.,0.\nINCLUDE '../\na.bdf'\n");
  EXPECT_THAT(test::read_error(folder.path() / "a" / "c.bdf"),
              HasSubstr("c.bdf:2: the included file '../a.bdf' is not in the deck's folder"));
}

TEST(Nastran, TakesCornersOfElementsThatLackSomeNodesOfEdges) {
  const TemporaryFolder folder;
  Notes notes;
  const std::string deck =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,.5,.5,0.\n"
      "CTRIA6,1,1,1,2,3,,4\n";
  const Mesh mesh = read_mesh(folder.file("a.nas", deck), {.notes = &notes});
  EXPECT_THAT(mesh.cells[0], ElementsAre(0, 1, 2));
  EXPECT_THAT(notes, ElementsAre(HasSubstr("one element is without some of the nodes of edges")));
  EXPECT_THAT(moved(deck, {3, 2, 1, 0}, {0}), HasSubstr("CTRIA6,1,1,4,3,2,,1\n"));
}

TEST(Nastran, ReadsNodesOfEdgesIntoTheOrderOfVtk) {
  struct Case {
    std::string card;
    std::vector<Point> corners;
    std::vector<std::array<std::size_t, 2>> of_nastran;  ///< edges by their corners
    std::vector<std::array<std::size_t, 2>> of_vtk;
  };
  const std::vector<Case> cases{
      {"CPENTA",
       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
       {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4}, {2, 5}, {3, 4}, {4, 5}, {5, 3}},
       {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
      {"CPYRAM",
       {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}},
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
  };
  for (const Case& of : cases) {
    const auto middle = [&](std::array<std::size_t, 2> edge) {
      const Point& a = of.corners[edge[0]];
      const Point& b = of.corners[edge[1]];
      return Point{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    };
    std::vector<Point> points = of.corners;
    for (const auto& edge : of.of_nastran) points.push_back(middle(edge));
    std::string deck;
    std::string element = of.card + ",1,1";
    for (std::size_t k = 0; k < points.size(); ++k) {
      deck += fmt::format("GRID,{},,{:.1f},{:.1f},{:.1f}\n", k + 1, points[k][0], points[k][1], points[k][2]);
      element += fmt::format("{},{}", (k + 2) % 8 == 0 ? "\n" : "", k + 1);
    }
    const TemporaryFolder folder;
    const Mesh mesh = read_mesh(folder.file("a.bdf", deck + element + "\n"));
    const auto cell = mesh.cells[0];
    ASSERT_EQ(cell.size(), points.size());
    for (std::size_t k = 0; k < of.of_vtk.size(); ++k) {
      EXPECT_EQ(mesh.points[cell[of.corners.size() + k]], middle(of.of_vtk[k])) << of.card << k;
    }
    // a mesh without the deck is written in Nastran's order, too
    Mesh other = mesh;
    other.format_metadata.reset();
    write_mesh(other, folder.path() / "b.bdf");
    EXPECT_EQ(read_mesh(folder.path() / "b.bdf").cells, mesh.cells);
  }
}

TEST(Nastran, WritesWhatChangedInItsDeck) {
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.bdf", kBulk));
  mesh.points[1] = {1.25, 0.5, 1e-7};
  for (DataArray& array : mesh.data) array.values = std::vector<std::int32_t>{5, 6, 11, 7};
  mesh.sets.push_back({"two", Association::cells, {0, 3}});
  Notes notes;
  write_mesh(mesh, folder.path() / "b.bdf", {.notes = &notes});
  EXPECT_THAT(notes, IsEmpty());
  const std::string text = test::content_of(folder.path() / "b.bdf");
  EXPECT_THAT(text, HasSubstr("GRID           2            1.25      .5.0000001       3  123456\n"));
  EXPECT_THAT(text, HasSubstr("CHEXA,2,6,5,6,7,8,9,10\n"));
  EXPECT_THAT(text, HasSubstr("CQUAD4  11              1"));
  EXPECT_THAT(text, HasSubstr("$ set: two\nSET3           2    ELEM       1      20\nENDDATA\n"));
  const Mesh back = read_mesh(folder.path() / "b.bdf");
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.sets, mesh.sets);
}

TEST(Nastran, WritesAndReadsMeshesOfOtherFormats) {
  const TemporaryFolder folder;
  const Mesh mesh = test::tetrahedral_bar(2);
  write_mesh(mesh, folder.path() / "a.bdf");
  const Mesh back = read_mesh(folder.path() / "a.bdf");
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(back.cells, mesh.cells);
}

TEST(Nastran, PutsNodesOfOtherSystemsIntoTheBasicOne) {
  // 1: x along the basic y, from (1, 0, 0). 2: cylindrical, within system 1. 3: spherical, within the basic
  // system. 4: given by the nodes 1, 2 and 3, z along the basic x.
  const std::string systems =
      "GRDSET,,1\n"
      "GRID,1,0,0.,0.,0.\n"
      "GRID,2,0,1.,0.,0.\n"
      "GRID,3,0,0.,0.,1.\n"
      "GRID,4,,2.,3.,4.\n"
      "GRID,5,2,2.,90.,4.\n"
      "GRID,6,3,2.,90.,90.\n"
      "GRID,7,3,2.,0.,45.\n"
      "GRID,8,4,1.,2.,3.\n"
      "CORD2R,1,,1.,0.,0.,1.,0.,1.\n,1.,1.,0.\n"
      "CORD2C,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
      "CORD2S,3,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
      "CORD1R,4,1,2,3\n"
      "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n";
  const TemporaryFolder folder;
  Mesh mesh = read_mesh(folder.file("a.bdf", systems));
  const std::vector<Point> expected{{0, 0, 0},  {1, 0, 0}, {0, 0, 1}, {-2, 2, 4},
                                    {-1, 0, 4}, {0, 2, 0}, {0, 0, 2}, {3, -2, 1}};
  ASSERT_EQ(mesh.points.size(), expected.size());
  for (std::size_t v = 0; v < expected.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mesh.points[v][k], expected[v][k], 1e-15) << v + 1;
  }
  write_mesh(mesh, folder.path() / "b.bdf");
  EXPECT_EQ(test::content_of(folder.path() / "b.bdf"), systems);
  mesh.points[4] = {7, 8, 9};
  write_mesh(mesh, folder.path() / "c.bdf");
  EXPECT_EQ(read_mesh(folder.path() / "c.bdf").points, mesh.points);
}

TEST(Nastran, RefusesFaultsWithTheirLine) {
  const std::vector<std::array<std::string, 3>> faults{
      {"GRID,99,,5.,5.,5.\n", "GRID,12,,5.,5.,5.\n", "23: node 12 is given twice"},
      {"GRID,99,,5.,5.,5.\n", "GRID,99,3,5.,5.,5.\n", "23: the coordinate system 3 is not given"},
      {"GRID,99,,5.,5.,5.\n", "GRID,99,-3,5.,5.,5.\n", "23: the system of a node is '-3'"},
      {"GRID,99,,5.,5.,5.\n", "GRID,99,,5.,5.x,5.\n", "23: a coordinate of node 99 is '5.x'"},
      {"GRID,99,,5.,5.,5.\n", "GRID,99,,5.,nan,5.\n", "23: a coordinate of node 99 is 'nan'"},
      {"GRID,99,,5.,5.,5.\n", "GRID,-3,,5.,5.,5.\n", "23: the number of a node is '-3'"},
      {"GRID,99,,5.,5.,5.\n", "GRID,99999999999,,5.,5.,5.\n", "23: the number of a node is '99999999999'"},
      {"CQUAD4  11              1 ", "CQUAD4  11              17", "29: a node of the element is 17"},
      {"CQUAD4  11 ", "CQUAD4  20 ", "30: element 20 is given twice"},
      {"CQUAD4  11              1       4       3       2\n", "CQUAD4,11,,1,4,3\n",
       "29: element 11 has 3 of the 4 nodes of CQUAD4"},
      {"6+A1\n", "6+B1\n", "24: continuation lines do not follow their card"},
      {"PSOLID  5       1\n",
       "CORD2R  3               0.      0.      0.      0.      0.      1.      +A\n+B      1.\n",
       "28: continuation lines do not follow their card; write it in fields"},
      {"CQUAD4  11              1 ", "CQUAD4  11            -3 1 ", "29: the property of an element is '-3'"},
      {"GRID,99,,5.,5.,5.\n", "GRID,99,,5.,5.,5.\n=,*1,=,*1.,==\n", "24: cards are repeated by '='"},
      {"PSOLID  5       1\n", "BEGIN SUPER=2\n", "28: a second section of bulk data begins"},
      {"PSOLID  5       1\n", "INCLUDE 'x.inc'\n", "28: the included file 'x.inc' does not exist"},
      {"PSOLID  5       1\n", "GRDSET,,3\n", ": the coordinate system 3 is not given"},
      {"PSOLID  5       1\n", "GRDSET,,3\nCORD1R,3,999,1,2\n",
       "29: node 999 of the coordinate system is missing"},
      {"PSOLID  5       1\n", "GRDSET,,3\nCORD1R,3,1,2,3\n", "29: the coordinate system refers to itself"},
      {"PSOLID  5       1\n", "GRDSET,,3\nCORD2R,3,3,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n",
       "29: the coordinate system refers to itself"},
      {"PSOLID  5       1\n", "GRDSET,,3\nCORD2R,3,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\n",
       "29: the three points of the coordinate system are on a line"},
      {"PSOLID  5       1\n", "CORD2R,3,,0.,0.,x,0.,0.,1.\n,0.,0.,2.\n", "28: a coordinate of CORD2R is 'x'"},
      {"PSOLID  5       1\n", "CORD1S,3,1,2,0\n", "28: field 5 of CORD1S is '0'"},
      {"PSOLID  5       1\n", "CORD1S,3,1,2,3,3,1,2,3\n", "28: the coordinate system 3 is given twice"},
      {"BEGIN BULK\n", "", "no BEGIN BULK after case control"},
  };
  const TemporaryFolder folder;
  for (const auto& [old, fresh, message] : faults) {
    EXPECT_THAT(test::read_error(folder.file("a.bdf", with(std::string(kBulk), old, fresh))),
                HasSubstr(message));
  }
  EXPECT_THAT(test::read_error(folder.file("a.bdf", "BEGIN BULK\nENDDATA\n")), HasSubstr("has no GRID"));
  EXPECT_THAT(test::read_error(folder.file("a.bdf", "GRID,1,,0.,0.,0.\n")), HasSubstr("has no elements"));
  EXPECT_THAT(
      test::read_error(folder.file("a.bdf", "GRID,1,,0.,0.,0.\nCORD2R,3\nCIHEX1,1,1,1\nCELAS2,2,1.,1\n")),
      HasSubstr("its only elements are of types that are not cells here (CIHEX1, CELAS2)"));
  EXPECT_THAT(test::read_error(folder.file("a.bdf", "+,1,,0.,0.,0.\n")),
              HasSubstr("a.bdf:1: expected a card"));
  EXPECT_THAT(test::read_error(folder.file("a.bdf", std::string_view("GRID\0,1", 7))),
              HasSubstr("is not a text file"));
}

TEST(Nastran, ReadsOrRefusesEveryPartOfAFile) {
  const TemporaryFolder folder;
  std::size_t read = 0;
  for (std::size_t length = 1; length < kBulk.size(); length += 7) {
    Notes notes;
    try {
      (void)read_mesh(folder.file("a.bdf", kBulk.substr(0, length)), {.notes = &notes});
      ++read;
      const bool is_cut = length < kBulk.find("ENDDATA") + 7;
      EXPECT_EQ(notes.empty(), !is_cut) << length;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.bdf"));
    }
  }
  EXPECT_GT(read, 0U);
}

TEST(Nastran, IsKnownByItsFirstLines) {
  const auto name = [](std::string_view bytes) {
    const Format* const format = format_of_bytes(bytes);
    return format == nullptr ? std::string_view() : format->name;
  };
  EXPECT_EQ(name(kBulk), "Nastran");
  EXPECT_EQ(name("$ a comment\n\nGRID*   1\n"), "Nastran");
  EXPECT_EQ(name("grid,1,,0.,0.,0.\n"), "Nastran");
  EXPECT_EQ(name("begin bulk\n"), "Nastran");
  EXPECT_EQ(name("$MeshFormat\n4.1 0 8\n"), "Gmsh");
}

}  // namespace
}  // namespace meshorder
