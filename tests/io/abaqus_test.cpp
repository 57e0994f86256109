// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/abaqus/abaqus.hpp"

#include "io/abaqus/cards.hpp"
#include "io/format.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

namespace meshorder {
namespace {

using abaqus::ElementKind;
using test::TemporaryFolder;
using test::with;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::StartsWith;
using testing::UnorderedElementsAre;

// two hexahedra, a wedge on them and shells, with all kinds of references
constexpr std::string_view kDeck =
    "*Heading\n"
    " a deck, 1, 2\n"
    "** made by hand\n"
    "*NODE, NSET=Nall\n"
    "1, 0., 0., 0.\n"
    "2, 1., 0, 0\n"
    "3, 1, 1, 0\n"
    "4, 0, 1, 0\n"
    "** between\n"
    "5, 0, 0, 1\n"
    "6, 1, 0, 1\n"
    "7, 1, 1, 1\n"
    "8, 0, 1, 1\n"
    "*Node\n"
    "9, .1D0, 0, 2\n"
    "10, 1, 0, 2\n"
    "11, 1, 1, 2\n"
    "12, 0, 1, 2\n"
    "13, .5, 0, 3\n"
    "14, .5, 1, 3\n"
    "99, 5, 5\n"
    "** elements\n"
    "*ELEMENT, TYPE=C3D8R, ELSET=solid\n"
    "1, 1, 2, 3, 4, 5, 6, 7, 8\n"
    "2, 5, 6, 7, 8,\n"
    "   9, 10, 11, 12\n"
    "*element,type=s4,\n"
    "  elset = \"the skin\"\n"
    "11, 1, 4, 3, 2\n"
    "12, 1, 2, 6, 5\n"
    "13, 5, 6, 10, 9\n"
    "*Element, type=C3D6, elset=solid\n"
    "20, 9, 10, 13, 12, 11, 14\n"
    "*NSET, nset=ENDS\n"
    "1, 14,\n"
    "3\n"
    "*nset, NSET=ends\n"
    "3, nall\n"
    "*ELSET, ELSET=even, GENERATE\n"
    "2, 20, 2\n"
    "*ELSET, ELSET=all, GENERATE\n"
    "11, 13, 1\n"
    "*NSET, NSET=of skin, ELSET=\"THE SKIN\"\n"
    "*SURFACE, NAME=top, TYPE=ELEMENT\n"
    "20, S2\n"
    "solid, S1\n"
    "*MATERIAL, NAME=steel\n"
    "*ELASTIC\n"
    "210000, 0.3\n"
    "*RIGID BODY, ELSET=all, REF NODE=99\n"
    "*EQUATION\n"
    "2\n"
    "13, 1, 1., 14, 1, -1.\n"
    "*MPC\n"
    "BEAM, 1, 2\n"
    "*Step, INC=10\n"
    "*Boundary\n"
    "ends, 1, 3\n"
    "10, 2, 2\n"
    "** not 13, 2\n"
    "*Cload\n"
    "  14 , 3, -10\n"
    "*DLOAD\n"
    "2, P1, 14.\n"
    "*FILM\n"
    "20, F2FC, 13, 5\n"
    "*END STEP";

Mesh read_deck(std::string_view content, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  return read_mesh(folder.file("m.inp", content), {.notes = notes});
}

std::string deck_of(const Mesh& mesh, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  write_mesh(mesh, folder.path() / "m.inp", notes);
  return test::content_of(folder.path() / "m.inp");
}

const EntitySet& set_of(const Mesh& mesh, std::string_view name) {
  const auto found = std::find_if(mesh.sets.begin(), mesh.sets.end(),
                                  [&](const EntitySet& set) { return set.name == name; });
  EXPECT_NE(found, mesh.sets.end()) << name;
  return found == mesh.sets.end() ? mesh.sets.front() : *found;
}

/// Moves the last vertex and the last cell of each block to the front.
void turn_round(Mesh& mesh, Ids ids) {
  std::vector<Index> vertices(mesh.points.size());
  std::iota(vertices.begin(), vertices.end(), Index{1});
  vertices.back() = 0;
  apply_reordering(mesh, Permutation::from_old_to_new(std::move(vertices)), test::shuffled_cells(mesh, 7),
                   ids);
}

TEST(Abaqus, ReadsNodesElementsAndSets) {
  Notes notes;
  const Mesh mesh = read_deck(kDeck, &notes);
  EXPECT_THAT(notes, IsEmpty());
  ASSERT_EQ(mesh.vertex_count(), 15);
  ASSERT_EQ(mesh.cell_count(), 6);
  EXPECT_EQ(mesh.points[8], (Point{0.1, 0, 2}));
  EXPECT_EQ(mesh.points[14], (Point{5, 5, 0}));
  EXPECT_EQ(mesh.dimension, 3);
  EXPECT_EQ(mesh.vertex_ids.back(), 99);
  EXPECT_THAT(mesh.cell_ids, ElementsAre(1, 2, 11, 12, 13, 20));
  EXPECT_THAT(mesh.cell_blocks, ElementsAre(0, 2, 5));
  EXPECT_THAT(mesh.cells[1], ElementsAre(4, 5, 6, 7, 8, 9, 10, 11));
  EXPECT_EQ(mesh.cells.shapes[2], Shape::quad);
  EXPECT_THAT(mesh.cells[5], ElementsAre(8, 9, 12, 11, 10, 13));
  EXPECT_THAT(set_of(mesh, "Nall").members, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(set_of(mesh, "solid").members, ElementsAre(0, 1, 5));
  EXPECT_THAT(set_of(mesh, "the skin").members, ElementsAre(2, 3, 4));
  EXPECT_THAT(set_of(mesh, "ENDS").members, ElementsAre(0, 13, 2, 1, 3, 4, 5, 6, 7));
  EXPECT_THAT(set_of(mesh, "even").members, ElementsAre(1, 3, 5));
  EXPECT_THAT(set_of(mesh, "of skin").members, ElementsAre(0, 3, 2, 1, 5, 4, 9, 8));
}

TEST(Abaqus, WritesWhatItReadButForTheLinesOfNodesAndElements) {
  const std::string written = deck_of(read_deck(kDeck));
  std::string expected(kDeck);
  expected = with(expected, "1, 0., 0., 0.\n2, 1., 0, 0\n", "** between\n1, 0, 0, 0\n2, 1, 0, 0\n");
  expected = with(expected, "4, 0, 1, 0\n** between\n", "4, 0, 1, 0\n");
  expected = with(expected, ".1D0", "0.1");
  expected = with(expected, "13, .5", "13, 0.5");
  expected = with(expected, "14, .5", "14, 0.5");
  expected = with(expected, "99, 5, 5\n", "99, 5, 5, 0\n");
  expected = with(expected, "2, 5, 6, 7, 8,\n   9", "2, 5, 6, 7, 8, 9");
  EXPECT_EQ(written, expected);
  EXPECT_EQ(deck_of(read_deck(written)), written);
}

std::vector<std::string> sorted_lines(std::string_view text) {
  std::vector<std::string> result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    result.emplace_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(Abaqus, BeginsALineAfterALastLineWithoutItsEnd) {
  const std::string deck =
      "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n*NODE";
  Mesh mesh = read_deck(deck);
  mesh.sets.push_back({.name = "new", .association = Association::vertices, .members = {1, 3}});
  const std::string text = deck_of(mesh);
  EXPECT_THAT(text, testing::EndsWith("\n*NODE\n*NSET, NSET=new\n2, 4\n"));
  EXPECT_EQ(read_deck(text).sets, mesh.sets);
}

TEST(Abaqus, WritesSetsOfNodesBeforeTheCardsThatUseThem) {
  const std::string nodes = "*NODE, NSET=first\n1, 0, 0, 0\n2, 1, 0, 0\n";
  const std::string rest = "*NODE\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n";
  const std::string user = "*NSET, NSET=more\nFIRST, 4\n";
  const std::string card = "*NSET, NSET=first\n2, 1\n";
  const auto order_of_sets = [&](const std::string& deck) {
    Mesh mesh = read_deck(deck);
    apply_reordering(mesh, Permutation::from_new_to_old({2, 1, 0, 3}), Permutation::identity(1), Ids::keep);
    const std::string text = deck_of(mesh);
    EXPECT_EQ(test::sorted_members(read_deck(text)).sets, test::sorted_members(mesh).sets) << text;
    return text;
  };
  // the set is written after the last card with nodes, not after a card without nodes
  EXPECT_THAT(order_of_sets(nodes + rest + "*NODE\n"), HasSubstr("4, 0, 0, 1\n" + card + "*ELEMENT"));
  EXPECT_THAT(order_of_sets(nodes + user + rest), HasSubstr(card + user + "*NODE\n"));
  EXPECT_THAT(order_of_sets(nodes + rest + user), HasSubstr("4, 0, 0, 1\n" + card + "*ELEMENT"));
}

TEST(Abaqus, MovesLinesAndKeepsNumbers) {
  const Mesh mesh = read_deck(with(std::string(kDeck), "*NODE, NSET=Nall", "*NODE"));
  Mesh moved = mesh;
  turn_round(moved, Ids::keep);
  const std::string text = deck_of(moved);
  const std::string original = deck_of(mesh);
  EXPECT_THAT(text, HasSubstr("*NODE\n** between\n99, 5, 5, 0\n1, 0, 0, 0\n"));
  EXPECT_EQ(text.substr(text.find("*NSET")), original.substr(original.find("*NSET")))
      << "cards after the mesh";
  EXPECT_EQ(sorted_lines(text), sorted_lines(original)) << "the same lines in another order";
  EXPECT_NE(text, original);
}

TEST(Abaqus, TakesNumbersAfterACommaAsData) {
  // what remains of Abaqus/CAE's "*Nset, nset=ends, instance=Part-1-1" without its last parameter
  const std::string deck(kDeck);
  std::string commas = deck;
  for (const std::string card :
       {"*NODE, NSET=Nall", "elset = \"the skin\"", "*NSET, nset=ENDS", "*ELSET, ELSET=even, GENERATE",
        "*EQUATION", "*MPC", "*Boundary", "*Cload", "*SURFACE, NAME=top, TYPE=ELEMENT", "*FILM"}) {
    commas = with(commas, card + "\n", card + (card.size() % 2 == 0 ? ",\n" : " , \n** comment\n\n"));
  }
  Mesh mesh = read_deck(commas);
  EXPECT_EQ(mesh.cell_count(), read_deck(deck).cell_count());
  EXPECT_EQ(set_of(mesh, "ENDS").members, set_of(read_deck(deck), "ENDS").members);
  turn_round(mesh, Ids::renumber);
  Mesh expected = read_deck(deck);
  turn_round(expected, Ids::renumber);
  // the decks are the same except for commas, comments and blank lines
  const auto plain = [](const std::string& text) {
    std::string result;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      std::string line = text.substr(begin, end - begin);
      line.erase(line.find_last_not_of(" ,") + 1);
      if (!line.empty() && line != "** comment") result += line + '\n';
      begin = end + 1;
    }
    return result;
  };
  EXPECT_EQ(plain(deck_of(mesh)), plain(deck_of(expected)));
}

TEST(Abaqus, ContinuesKeywordLinesWithParameters) {
  const std::string mesh(kDeck.substr(0, kDeck.find("*NSET")));
  const auto members = [&](const std::string& cards) {
    Notes notes;
    std::vector<Index> result = set_of(read_deck(mesh + cards, &notes), "s").members;
    EXPECT_THAT(notes, IsEmpty()) << cards;
    return result;
  };
  EXPECT_THAT(members("*NSET, NSET=s,\nGENERATE\n1, 7, 3\n"), ElementsAre(0, 3, 6));
  EXPECT_THAT(members("*NSET, NSET=s, \n** a comment, with a comma,\n\n  Generate, internal,\n1, 7, 3\n"),
              ElementsAre(0, 3, 6));
  EXPECT_THAT(members("*NSET,\r\nNSET=s,\r\n unsorted\r\n7, 1\r\n"), ElementsAre(6, 0));
  EXPECT_THAT(members("*NSET, NSET=s, INTERNAL,\n7, 1\n"), ElementsAre(6, 0));
  EXPECT_THAT(members("*NSET, NSET=a\n4\n*NSET, NSET=s,\na\n"), ElementsAre(3)) << "the name of a set";
  EXPECT_THAT(members("*NSET, NSET=generated\n4\n*NSET, NSET=s,\ngenerated, 1\n"),
              UnorderedElementsAre(3, 0));

  Mesh moved = read_deck(mesh + "*NSET, NSET=s,\n** kept\nGENERATE\n1, 7, 3\n");
  turn_round(moved, Ids::renumber);
  EXPECT_THAT(deck_of(moved), HasSubstr("*NSET, NSET=s\n2, 5, 8\n"));
}

TEST(Abaqus, RangesOfNumbersOfAnySizeEnd) {
  const std::string mesh(kDeck.substr(0, kDeck.find("*NSET")));
  const auto members = [&](const std::string& range) {
    return set_of(read_deck(mesh + "*NSET, NSET=s, GENERATE\n" + range + "\n"), "s").members;
  };
  EXPECT_THAT(members("1, 9223372036854775807, 9223372036854775806"), ElementsAre(0));
  EXPECT_THAT(members("1, 9223372036854775807, 1"), Contains(0));
}

TEST(Abaqus, RenumbersAllThatNamesNodesAndElements) {
  Mesh mesh = read_deck(kDeck);
  turn_round(mesh, Ids::renumber);
  const std::string text = deck_of(mesh);
  // node 99 is the first now, and all others have moved up by one
  EXPECT_THAT(text, HasSubstr("*NODE\n** between\n1, 5, 5, 0\n2, 0, 0, 0\n"));
  EXPECT_THAT(
      text, HasSubstr("14, 0.5, 0, 3\n99, 0.5, 1, 3\n*NSET, NSET=Nall\n2, 3, 4, 5, 6, 7, 8, 9\n** elements"))
      << "the set of a card whose nodes are in two cards now";
  EXPECT_THAT(text, HasSubstr("*NSET, nset=ENDS\n2, 99,\n4\n*nset, NSET=ends\n4, nall\n"));
  EXPECT_THAT(text, HasSubstr("REF NODE=1\n"));
  EXPECT_THAT(text, HasSubstr("*EQUATION\n2\n14, 1, 1., 99, 1, -1.\n*MPC\nBEAM, 2, 3\n"));
  EXPECT_THAT(text,
              HasSubstr("INC=10\n*Boundary\nends, 1, 3\n11, 2, 2\n** not 13, 2\n*Cload\n  99 , 3, -10\n"));
  EXPECT_THAT(text, HasSubstr("*FILM\n20, F2FC, 14, 5\n"));
  EXPECT_THAT(text, HasSubstr("*ELASTIC\n210000, 0.3\n"));
  EXPECT_THAT(text, HasSubstr("*ELSET, ELSET=all, GENERATE\n11, 13, 1\n")) << "all of a block stay all of it";
  EXPECT_TRUE(text.starts_with(kDeck.substr(0, kDeck.find("*NODE"))));
  EXPECT_EQ(deck_of(read_deck(text)), text);
  test::expect_same(test::sorted_members(read_deck(text)), test::sorted_members(mesh));
}

TEST(Abaqus, ListsARangeThatIsNoneAnyMore) {
  Mesh mesh = read_deck(with(std::string(kDeck), "2, 20, 2\n", "2, 20, 2\n** behind it\n"));
  std::vector<Index> cells(mesh.cells.shapes.size());
  std::iota(cells.begin(), cells.end(), Index{0});
  std::swap(cells[2], cells[3]);
  apply_reordering(mesh, Permutation::identity(mesh.vertex_count()),
                   Permutation::from_old_to_new(std::move(cells)));
  const std::string text = deck_of(mesh);
  EXPECT_THAT(text, HasSubstr("*ELSET, ELSET=even\n2, 11, 20\n** behind it\n"));
}

TEST(Abaqus, KeepsTheOrderOfUnsortedRanges) {
  Mesh mesh = read_deck(
      "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"
      "*NSET, NSET=a, UNSORTED, GENERATE\n1, 3\n*NSET, NSET=b, GENERATE\n1, 3\n");
  apply_reordering(mesh, Permutation::from_old_to_new({1, 0, 2, 3}), Permutation::identity(1));
  EXPECT_THAT(deck_of(mesh), HasSubstr("*NSET, NSET=a, UNSORTED\n2, 1, 3\n*NSET, NSET=b, GENERATE\n1, 3\n"));
}

TEST(Abaqus, ComesBackFromAnyOrder) {
  for (const std::string& deck : {std::string(kDeck), with(std::string(kDeck), "*FILM", "*USER")}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Mesh mesh = read_deck(deck);
      const Permutation vertices = test::shuffled(mesh.vertex_count(), seed);
      const Permutation cells = test::shuffled_cells(mesh, seed);
      Mesh moved = mesh;
      apply_reordering(moved, vertices, cells);
      Mesh back = read_deck(deck_of(moved));
      test::expect_same(test::sorted_members(back), test::sorted_members(moved));
      apply_reordering(back, vertices.inverse(), cells.inverse());
      test::expect_same(test::sorted_members(back), test::sorted_members(mesh));
      // cards come back, too, but ranges and sets of cards are lists now
      const std::string text = deck_of(back);
      EXPECT_THAT(text, HasSubstr(kDeck.substr(kDeck.find("*SURFACE"),
                                               kDeck.find("*FILM") - kDeck.find("*SURFACE"))));
    }
  }
}

TEST(Abaqus, KeepsNumbersWhereACardMayNameThem) {
  const std::string deck = with(std::string(kDeck), "*FILM", "*NEW LOAD");
  Notes notes;
  Mesh mesh = read_deck(deck, &notes);
  EXPECT_THAT(notes,
              ElementsAre("all nodes and elements keep their numbers, and only their lines move, since "
                          "these may refer to their numbers or order: *NEW LOAD (line 65)"));
  const std::vector<std::int64_t> ids = mesh.vertex_ids;
  turn_round(mesh, Ids::renumber);
  EXPECT_EQ(mesh.vertex_ids.front(), 99);
  EXPECT_THAT(deck_of(mesh), HasSubstr(kDeck.substr(kDeck.find("*NSET"), 400)));
  mesh.vertex_ids = ids;
  const TemporaryFolder folder;
  EXPECT_THAT(test::write_error(mesh, folder.path() / "m.inp"), HasSubstr("*NEW LOAD (line 65); keep them"));

  notes.clear();
  (void)read_deck(with(std::string(kDeck), "BEAM, 1, 2\n", "TIE, ends, nall\n"), &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("*MPC (line 54)")));
  notes.clear();
  (void)read_deck(with(std::string(kDeck), "*FILM\n20, F2FC, 13, 5", "*NEW LOAD\n200, F2FC, 1000"), &notes);
  EXPECT_THAT(notes, IsEmpty()) << "no node or element has such a number";
}

TEST(Abaqus, RefusesIdsThatAreNoNumbersOfADeck) {
  const Mesh right = read_deck(kDeck);
  const TemporaryFolder folder;
  const auto refusal = [&](auto change) {
    Mesh mesh = right;
    change(mesh);
    return test::write_error(mesh, folder.path() / "m.inp");
  };
  EXPECT_THAT(refusal([](Mesh& mesh) { mesh.vertex_ids[3] = -5; }),
              HasSubstr("the id of vertex 3 is -5; ids are 1 to 999999999"));
  EXPECT_THAT(refusal([](Mesh& mesh) { mesh.cell_ids[2] = 1'000'000'000; }),
              HasSubstr("the id of cell 2 is 1000000000"));
  EXPECT_THAT(refusal([](Mesh& mesh) { mesh.cell_ids[1] = mesh.cell_ids[4]; }),
              HasSubstr("the id 13 is that of cell 1 and of cell 4"));
}

TEST(Abaqus, KeepsNumbersWhereResultsGoByThem) {
  for (const std::string card :
       {"*TIE, NAME=t, CYCLIC SYMMETRY\ntop, top\n*CYCLIC SYMMETRY MODEL, N=8, TIE=t\n0,0,0,0,0,1\n",
        "*RESTART, READ, STEP=1\n", "*VIEWFACTOR, READ\n"}) {
    Notes notes;
    Mesh mesh = read_deck(with(std::string(kDeck), "*Step, INC=10", card + "*Step, INC=10"), &notes);
    EXPECT_THAT(notes, testing::Contains(HasSubstr("keep their numbers"))) << card;
    turn_round(mesh, Ids::renumber);
    EXPECT_THAT(deck_of(mesh), HasSubstr(std::string(kDeck.substr(kDeck.find("*NSET"), 80)))) << card;
  }
  for (const std::string card : {"*TIE, NAME=t\ntop, top\n", "*RESTART, WRITE\n", "*VIEWFACTOR, WRITE\n"}) {
    Notes notes;
    (void)read_deck(with(std::string(kDeck), "*Step, INC=10", card + "*Step, INC=10"), &notes);
    EXPECT_THAT(notes, Not(testing::Contains(HasSubstr("keep their numbers")))) << card;
  }
}

TEST(Abaqus, KeepsElementsOfTypesThatItDoesNotKnow) {
  const std::string deck = with(std::string(kDeck), "*NSET, nset=ENDS",
                                "*ELEMENT, TYPE=U1, ELSET=user\n31, 1,\n2\n32, 2, 3\n*ELSET, ELSET=odd\n"
                                "31, 1\n*NSET, nset=ENDS");
  Notes notes;
  Mesh mesh = read_deck(deck, &notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("elements of type U1 (line 34)")));
  EXPECT_EQ(mesh.cell_count(), 6);
  EXPECT_THAT(set_of(mesh, "odd").members, ElementsAre(0));
  EXPECT_THAT(set_of(mesh, "user").members, IsEmpty());
  turn_round(mesh, Ids::renumber);
  EXPECT_THAT(deck_of(mesh), HasSubstr("TYPE=U1, ELSET=user\n31, 1,\n2\n32, 2, 3\n"));
}

TEST(Abaqus, SaysWhichElementsAreNoCells) {
  const TemporaryFolder folder;
  const std::string nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n";
  const std::string users = nodes + "*USER ELEMENT,TYPE=US3,NODES=3\n*ELEMENT,TYPE=US3,ELSET=E\n1,1,2,3\n";
  EXPECT_THAT(test::read_error(folder.file("a.inp", users)),
              HasSubstr("a.inp: its only elements are of types that are not cells here (US3, line 6); "
                        "correct TYPE= if it is misspelt; C3D4,"));
  std::string many = users;
  for (const char* type : {"D", "U1", "U2"}) many += "*ELEMENT,TYPE=" + std::string(type) + "\n7,1,2\n";
  EXPECT_THAT(test::read_error(folder.file("b.inp", many)),
              HasSubstr("(US3, line 6; D, line 8; U1, line 10)"));
  EXPECT_THAT(test::read_error(folder.file("c.inp", nodes)), HasSubstr("has no *ELEMENT"));
}

TEST(Abaqus, KeepsWhatFollowsCoordinatesAndNodes) {
  const std::string deck =
      "*NODE\n1,0,0,0\n2,1,0,0,\n3,1,1,0, 0., 0.,1.\n4,0,1, ,0.\n*ELEMENT,TYPE=CPS4\n1,1,2,3,4,2,1,\n"
      "*ELEMENT,TYPE=CPS3\n2,1,2,3\n";
  Mesh mesh = read_deck(deck);
  EXPECT_EQ(mesh.points[3], (Point{0, 1, 0}));
  apply_reordering(mesh, Permutation::from_old_to_new({1, 2, 3, 0}), Permutation::identity(2));
  Notes notes;
  EXPECT_EQ(deck_of(mesh, &notes),
            "*NODE\n1, 0, 1, 0, 0.\n2, 0, 0, 0\n3, 1, 0, 0\n4, 1, 1, 0, 0., 0.,1.\n*ELEMENT,TYPE=CPS4\n"
            "1, 2, 3, 4, 1, 2,1,\n*ELEMENT,TYPE=CPS3\n2, 2, 3, 4\n");
  EXPECT_THAT(
      notes,
      ElementsAre(HasSubstr("fields after the coordinates of 2 nodes are not supported and stay as they are"),
                  HasSubstr("numbers after the last node of an element stay as they are")));
  const TemporaryFolder folder;
  EXPECT_THROW((void)write_mesh(mesh, folder.path() / "m.inp", WriteOptions{.strict = true}), InputError);
  EXPECT_THAT(folder.names(), IsEmpty());
  EXPECT_THAT(mesh.format_metadata->contents(), testing::Contains("fields after the coordinates of nodes"));
}

TEST(Abaqus, ReadsIncludedFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "sub");
  (void)folder.file("sub/nodes.txt", "1, 0, 0, 0\r\n2, 1, 0, 0\r\n3, 0, 1, 0\r\n4, 0, 0, 1");
  (void)folder.file("cells.inc", "*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4");
  Notes notes;
  const Mesh mesh = read_mesh(folder.file("m.inp",
                                          "*NODE, INPUT=sub/nodes.txt, NSET=all\n*Include, Input=cells.inc\n"
                                          "*NSET, NSET=a\n4\n"),
                              {.notes = &notes});
  EXPECT_THAT(notes, ElementsAre("included files are now part of the deck: sub/nodes.txt, cells.inc"));
  EXPECT_EQ(deck_of(mesh),
            "*NODE, NSET=all\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
            "*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n*NSET, NSET=a\n4\n");

  for (const auto& [name, fault] :
       {std::pair{"/etc/passwd", "is not in the deck's folder"},
        std::pair{"../m.inp", "is not in the deck's folder"}, std::pair{"none.inc", "does not exist"},
        std::pair{"n.inp", "includes itself"}}) {
    const auto path = folder.file("n.inp", std::string("** first\n*INCLUDE, INPUT=") + name + "\n");
    EXPECT_THAT(test::read_error(path), HasSubstr(fault));
    EXPECT_THAT(test::read_error(path), HasSubstr("n.inp:2: "));
  }
}

TEST(Abaqus, ReadsDataLinesOfIncludedFiles) {
  const TemporaryFolder folder;
  (void)folder.file("nodes.txt", "3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 1, 1");
  (void)folder.file("cells.txt", "8, 2, 3, 4, 5\n");
  (void)folder.file("set.txt", "3, 4");
  const Mesh mesh = read_mesh(folder.file("m.inp",
                                          "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n*INCLUDE, INPUT=nodes.txt\n"
                                          "6, 2, 2, 2\n*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n"
                                          "*Include,\n input=cells.txt\n9, 3, 4, 5, 6\n"
                                          "*NSET, NSET=a\n1\n*INCLUDE, INPUT=set.txt\n"));
  EXPECT_EQ(mesh.vertex_count(), 6);
  EXPECT_EQ(mesh.cell_count(), 3);
  EXPECT_THAT(set_of(mesh, "a").members, ElementsAre(0, 2, 3));
  EXPECT_EQ(deck_of(mesh),
            "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n5, 1, 1, 1\n6, 2, 2, 2\n"
            "*ELEMENT, TYPE=C3D4\n7, 1, 2, 3, 4\n8, 2, 3, 4, 5\n9, 3, 4, 5, 6\n"
            "*NSET, NSET=a\n1\n3, 4\n");
}

TEST(Abaqus, ReadsOnePartInOneInstance) {
  constexpr std::string_view kParts =
      "*Part, name=beam\n*Node\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*Element, type=C3D4\n"
      "1, 1, 2, 3, 4\n*Nset, nset=a\n1\n*End Part\n*Assembly, name=all\n*Instance, name=beam-1, part=beam\n"
      "*End Instance\n*Nset, nset=A, instance=beam-1\n2, 3\n*Nset, nset=b\nbeam-1.4, beam-1.a, A\n"
      "*End Assembly\n*Step\n*Boundary\nbeam-1.4, 1\n*End Step\n";
  Mesh mesh = read_deck(kParts);
  ASSERT_EQ(mesh.sets.size(), 3U);
  EXPECT_THAT(set_of(mesh, "a").members, ElementsAre(0));
  EXPECT_THAT(set_of(mesh, "Assembly.A").members, ElementsAre(1, 2));
  EXPECT_THAT(set_of(mesh, "b").members, ElementsAre(3, 0, 1, 2));
  EXPECT_EQ(deck_of(mesh), kParts);
  turn_round(mesh, Ids::renumber);
  EXPECT_THAT(deck_of(mesh), HasSubstr("3, 4\n*Nset, nset=b\nbeam-1.1, beam-1.a, A\n"));
  EXPECT_THAT(deck_of(mesh), HasSubstr("*Boundary\nbeam-1.1, 1\n"));

  const std::string second = with(std::string(kParts), "*End Instance\n",
                                  "*End Instance\n*Instance, name=beam-2, part=beam\n*End Instance\n");
  const TemporaryFolder folder;
  EXPECT_THAT(test::read_error(folder.file("m.inp", second)), HasSubstr(":15: a second *INSTANCE"));
  const std::string of_assembly = with(std::string(kParts), "*End Assembly\n", "*Node\n1, 2, 3, 4\n");
  EXPECT_THAT(test::read_error(folder.file("m.inp", of_assembly)), HasSubstr(":19: *NODE of the assembly"));
}

TEST(Abaqus, KeepsLineEndsOfTheFile) {
  std::string deck(kDeck);
  for (std::size_t at = deck.find('\n'); at != std::string::npos; at = deck.find('\n', at + 2)) {
    deck.replace(at, 1, "\r\n");
  }
  Mesh mesh = read_deck(deck);
  turn_round(mesh, Ids::renumber);
  std::string text = deck_of(mesh);
  for (std::size_t at = text.find("\r\n"); at != std::string::npos; at = text.find("\r\n", at))
    text.erase(at, 2);
  EXPECT_THAT(text, Not(testing::AnyOf(HasSubstr("\n"), HasSubstr("\r"))));
}

TEST(Abaqus, KnowsTypesByRule) {
  const auto is = [](std::string_view type, Shape shape, int nodes) {
    const auto kind = abaqus::kind_of(type);
    return kind && *kind == ElementKind{shape, nodes};
  };
  for (const std::string_view type : {"C3D4", "C3D4H", "DC3D4", "AC3D4", "F3D4", "C3D4P"}) {
    EXPECT_TRUE(is(type, Shape::tetrahedron, 4)) << type;
  }
  for (const std::string_view type : {"C3D10", "C3D10M", "C3D10MH", "C3D10T", "DC3D10"}) {
    EXPECT_TRUE(is(type, Shape::tetrahedron, 10)) << type;
  }
  for (const std::string_view type : {"C3D8", "C3D8R", "C3D8I", "C3D8RHT", "SC8R", "COH3D8", "DCC3D8D"}) {
    EXPECT_TRUE(is(type, Shape::hexahedron, 8)) << type;
  }
  for (const std::string_view type : {"S3", "S3R", "STRI3", "CPS3", "CPE3", "CAX3", "R3D3", "M3D3", "DS3"}) {
    EXPECT_TRUE(is(type, Shape::triangle, 3)) << type;
  }
  for (const std::string_view type :
       {"S4", "S4R5", "CPEG4R", "CAX4RHT", "M3D4R", "SFM3D4", "R3D4", "COH2D4"}) {
    EXPECT_TRUE(is(type, Shape::quad, 4)) << type;
  }
  for (const std::string_view type :
       {"B21", "B31H", "B33", "PIPE31", "T2D2", "T3D2", "SAX1", "SPRINGA", "ELBOW31"}) {
    EXPECT_TRUE(is(type, Shape::line, 2)) << type;
  }
  for (const std::string_view type : {"B22", "B32OS", "T3D3", "SAX2", "PIPE32"}) {
    EXPECT_TRUE(is(type, Shape::line, 3)) << type;
  }
  EXPECT_TRUE(is("C3D5", Shape::pyramid, 5));
  EXPECT_TRUE(is("C3D6", Shape::wedge, 6));
  EXPECT_TRUE(is("C3D15", Shape::wedge, 15));
  EXPECT_TRUE(is("C3D20RP", Shape::hexahedron, 20));
  EXPECT_TRUE(is("STRI65", Shape::triangle, 6));
  EXPECT_TRUE(is("S8R5", Shape::quad, 8));
  EXPECT_TRUE(is("S9R5", Shape::quad, 9));
  EXPECT_TRUE(is("MASS", Shape::vertex, 1));
  for (const std::string_view type : {"U1", "C3D27", "CONN3D2", "CIN3D8", "D", "C3D", "S", ""}) {
    EXPECT_FALSE(abaqus::kind_of(type)) << type;
  }
}

TEST(Abaqus, WritesAllTypesThatItHolds) {
  const Format& format = format_named("abaqus");
  int held = 0;
  for (const auto& [shape, count] : test::common_types()) {
    Mesh mesh = test::cells_of_type(shape, count, 3);
    mesh.data.clear();
    for (Point& point : mesh.points) {
      for (double& x : point) x = std::round(x * 1e6) / 1e6;  // written without loss
    }
    if (!format.holds(mesh, shape, count)) continue;
    ++held;
    test::expect_write_and_read(mesh, "m.inp");
    const Mesh again = read_deck(deck_of(mesh));
    EXPECT_EQ(again.cells, mesh.cells) << type_name(shape, count);
    EXPECT_EQ(deck_of(again), deck_of(mesh)) << type_name(shape, count);
  }
  EXPECT_EQ(held, 14);
}

TEST(Abaqus, WritesAtMostSixteenNumbersOnALine) {
  Mesh mesh = test::cells_of_type(Shape::hexahedron, 20, 1);
  std::vector<Index> all(20);
  std::iota(all.begin(), all.end(), 0);
  mesh.sets = {{"seventeen", Association::vertices, {all.begin(), all.begin() + 17}},
               {"sixteen", Association::vertices, {all.begin(), all.begin() + 16}}};
  std::istringstream text(write_mesh_to_memory(mesh, "abaqus", "m.inp").files.front().bytes);
  std::map<std::string, std::vector<std::ptrdiff_t>> numbers;  // of each line, by the keyword before it
  std::string keyword;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with('*')) {
      keyword = line;
    } else {
      numbers[keyword].push_back(std::count(line.begin(), line.end(), ',') + (line.ends_with(',') ? 0 : 1));
    }
  }
  EXPECT_THAT(numbers, Contains(Pair(StartsWith("*ELEMENT"), ElementsAre(16, 5))));
  EXPECT_THAT(numbers, Contains(Pair(HasSubstr("=seventeen"), ElementsAre(16, 1))));
  EXPECT_THAT(numbers, Contains(Pair(HasSubstr("=sixteen"), ElementsAre(16))));
}

TEST(Abaqus, PutsTheMiddleOfALineBetweenItsEnds) {
  const Mesh mesh = test::cells_of_type(Shape::line, 3, 1);
  EXPECT_THAT(deck_of(mesh), HasSubstr("*ELEMENT, TYPE=T3D3\n1, 1, 3, 2\n"));
}

TEST(Abaqus, WritesAPlainDeck) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1e-300}};
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.cells.push_back(Shape::triangle, std::array<Index, 3>{0, 2, 1});
  mesh.vertex_ids = {5, 6, 7, 9};
  mesh.data = {{std::string(kLabel), Association::cells, 1, std::vector<std::int32_t>{3, 4}, {}, {}}};
  mesh.sets = {{"a b", Association::vertices, {0, 3}},
               {"A_B", Association::vertices, {1}},
               {"1", Association::cells, {1}},
               {"none", Association::cells, {}}};
  Notes notes;
  EXPECT_EQ(deck_of(mesh, &notes),
            "*NODE\n5, 0, 0, 0\n6, 1, 0, 0\n7, 0, 1, 0\n9, 0, 0, -1e-300\n"
            "*ELEMENT, TYPE=C3D4\n1, 5, 6, 7, 9\n*ELEMENT, TYPE=S3\n2, 5, 7, 6\n"
            "*NSET, NSET=a_b\n5, 9\n*NSET, NSET=A_B_2\n6\n*ELSET, ELSET=set_1\n2\n"
            "*ELSET, ELSET=label_3\n1\n*ELSET, ELSET=label_4\n2\n");
  EXPECT_THAT(notes, ElementsAre("labels of cells are written as sets named label_N",
                                 "the set 'a b' is written as 'a_b'", "the set 'A_B' is written as 'A_B_2'",
                                 "the set '1' is written as 'set_1'",
                                 "the set 'none' of cells is not written: it has no members"));
}

std::string short_real(double value) { return std::string(abaqus::RealText(value).text()); }

TEST(Abaqus, WritesNumbersInTwentyCharacters) {
  EXPECT_EQ(short_real(1), "1");
  EXPECT_EQ(short_real(1e-5), "1e-5");
  EXPECT_EQ(short_real(1e100), "1e100");
  EXPECT_EQ(short_real(-0.1), "-0.1");
  EXPECT_EQ(short_real(-0.000997305283291371), "-9.97305283291371e-4") << "as it is, in 20 characters";
  for (const double value : {-1.2345678901234567e-5, -1.2345678901234567e-105, 0.00012345678901234567,
                             -123456.78901234567, 0.1 + 0.2, -2.2250738585072014e-308}) {
    const std::string text = short_real(value);
    EXPECT_LE(text.size(), 20U) << text;
    double again = 0;
    std::from_chars(text.data(), text.data() + text.size(), again);
    EXPECT_NEAR(again / value, 1, 1e-12) << text;
  }
  Mesh mesh = test::cells_of_type(Shape::triangle, 3, 1);
  mesh.points = {{-1.2345678901234567e-5, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Notes notes;
  (void)deck_of(mesh, &notes);
  EXPECT_THAT(notes, testing::Contains(HasSubstr("one coordinate is rounded")));
}

TEST(Abaqus, AddsNewSetsToItsDeck) {
  Mesh mesh = read_deck(kDeck);
  mesh.sets.push_back({"new", Association::vertices, {14, 0}});
  const std::string text = deck_of(mesh);
  EXPECT_THAT(text, HasSubstr("20, 9, 10, 13, 12, 11, 14\n*NSET, NSET=new\n99, 1\n*NSET, nset=ENDS"));
  mesh.sets.front().members.pop_back();
  Notes notes;
  (void)deck_of(mesh, &notes);
  EXPECT_THAT(
      notes, ElementsAre("the set 'Nall' of vertices is written as the deck has it; changes to it are lost"));
}

TEST(Abaqus, IsAPlainDeckAfterCellsWereLeftOut) {
  Mesh mesh = read_deck(kDeck);
  (void)keep_cells(mesh, {.dimension = 2});
  Notes notes;
  const std::string text = deck_of(mesh, &notes);
  EXPECT_THAT(text, HasSubstr("*ELEMENT, TYPE=S4\n11, 1, 4, 3, 2\n12, 1, 2, 6, 5\n13, 5, 6, 10, 9\n"));
  EXPECT_THAT(text, Not(HasSubstr("*MATERIAL")));
  EXPECT_THAT(notes, testing::Contains(HasSubstr("cards of the deck: *SURFACE, *MATERIAL, *ELASTIC")));
}

TEST(Abaqus, NamesWhatOthersLose) {
  const Mesh mesh = read_deck(kDeck);
  EXPECT_THAT(mesh.format_metadata->contents(),
              ElementsAre("the types of elements C3D8R", "surfaces of the deck: 'top'",
                          HasSubstr("cards of the deck: *SURFACE, *MATERIAL")));
}

TEST(Abaqus, DiffersFromVegaInItsFirstBytes) {
  const auto is = [](std::string_view bytes) {
    const Format* const format = format_of_bytes(bytes);
    return format == nullptr ? "" : std::string(format->name);
  };
  EXPECT_EQ(is("** comment\n*Heading\n"), "Abaqus");
  EXPECT_EQ(is("\n*NODE\n1, 2, 3, 4"), "Abaqus");
  EXPECT_EQ(is("*Include, input=a.inp"), "Abaqus");
  EXPECT_EQ(is("*MATERIAL, NAME=a\n*NODE"), "Abaqus");
  EXPECT_EQ(is("*VERTICES\n4 3"), "Vega");
  EXPECT_EQ(is("*MATERIAL steel\nENU, 1, 2\n*VERTICES\n"), "Vega");
  EXPECT_EQ(is("*INCLUDE a.veg\n"), "Vega");
}

TEST(Abaqus, NotesMembersThatDoNotExist) {
  Notes notes;
  const std::string deck = with(std::string(kDeck), "1, 14,\n3\n", "1, 14,\n3, 77, 78, nobody\n");
  const Mesh mesh = read_deck(deck, &notes);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_THAT(notes[0],
              HasSubstr("m.inp:34: the node set 'ENDS' names 2 numbers that the deck does not have, the "
                        "first is 77"));
  EXPECT_THAT(notes[1], HasSubstr("the set 'nobody', which does not exist"));
}

TEST(Abaqus, NotesWhatCardsNameButTheDeckDoesNotHave) {
  Notes notes;
  (void)read_deck(
      std::string(kDeck) +
          "\n*CLOAD\n4999, 1, 5.\nTIPP, 1, 5.\ntipp, 2, 5.\nENDS, 1, 2.\n*SURFACE, NAME=s\nNOBODY, S1\n"
          "*SURFACE, NAME=t, COMBINE=UNION\ns, top\n*DLOAD\n, GRAV, 9.81, 0, 0, 1\n",
      &notes);
  EXPECT_THAT(
      notes,
      ElementsAre(HasSubstr(": *CLOAD names one number that the deck does not have, the first is 4999"),
                  HasSubstr(": *CLOAD names the node set 'TIPP', which the deck does not have"),
                  HasSubstr(": *SURFACE names the element set 'NOBODY', which the deck does not")));
}

TEST(Abaqus, SuggestsTheKeywordThatAMisspeltOneIsNear) {
  Notes notes;
  (void)read_deck(std::string(kDeck) + "\n*CLOD\n1, 1, 5.\n*USER ELEMENT\n1, 2\n", &notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("; did you mean '*CLOAD'?), *USER ELEMENT (line "));
}

TEST(Abaqus, RefusesBrokenFiles) {
  const auto changed = [](std::string_view old, std::string_view fresh) {
    return with(std::string(kDeck), old, fresh);
  };
  const auto line_of = [](std::string_view text) {
    const std::string_view before = kDeck.substr(0, kDeck.find(text));
    std::string result = ":";
    result.append(std::to_string(1 + std::count(before.begin(), before.end(), '\n')));
    return result.append(": ");
  };
  test::expect_broken(
      "m.inp",
      {{"no keyword", "1, 2, 3\n*NODE\n", ":1: expected a keyword such as *NODE, found '1, 2, 3'"},
       {"no nodes", "*ELEMENT, TYPE=C3D4\n", "has no *NODE"},
       {"no elements", "*NODE\n1, 2, 3\n", "has no *ELEMENT"},
       {"a word", changed("3, 1, 1, 0", "3, 1, one, 0"), line_of("3, 1, 1, 0") + "a coordinate is 'one'"},
       {"not finite", changed("3, 1, 1, 0", "3, 1, nan, 0"),
        line_of("3, 1, 1, 0") + "a coordinate is not finite"},
       {"huge", changed("3, 1, 1, 0", "3, 1, 1e999, 0"), line_of("3, 1, 1, 0") + "a coordinate is 1e999"},
       {"number 0", changed("3, 1, 1, 0", "0, 1, 1, 0"), line_of("3, 1, 1, 0") + "the number of a node is 0"},
       {"huge number", changed("3, 1, 1, 0", "3000000000, 1, 1, 0"), "1 to 2147483647 are possible"},
       {"node twice", changed("3, 1, 1, 0", "2, 1, 1, 0"), line_of("3, 1, 1, 0") + "node 2 is given twice"},
       {"element twice", changed("12, 1, 2, 6, 5", "11, 1, 2, 6, 5"),
        line_of("12, 1, 2, 6, 5") + "element 11 is given twice"},
       {"no such node", changed("12, 1, 2, 6, 5", "12, 1, 2, 6, 55"),
        line_of("12, 1, 2, 6, 5") + "a node of the element is 55, which no *NODE has"},
       {"too few nodes", changed("12, 1, 2, 6, 5", "12, 1, 2, 6"),
        line_of("12, 1, 2, 6, 5") +
            "element 12 has 3 nodes on its line, but S4 has 4; TYPE=S4 of its *ELEMENT"},
       {"unknown type", "*NODE\n1, 0\n*ELEMENT, TYPE=C3D9\n1, 1\n", "(C3D9, line 3); correct TYPE= if it is"},
       {"cut element", changed("13, 5, 6, 10, 9", "13, 5, 6"),
        line_of("*Element, type=C3D6") + "element 13 has 2 of the 4 nodes of S4"},
       {"no type", changed("type=C3D6", "typ=C3D6"), line_of("*Element, type=C3D6") + "*ELEMENT has no TYPE"},
       {"no name", changed("nset=ENDS", "set=ENDS"), line_of("*NSET, nset=ENDS") + "*NSET has no name"},
       {"generated nodes", changed("*Step", "*NGEN"), line_of("*Step") + "*NGEN makes nodes or elements"},
       {"cylindrical nodes", changed("NSET=Nall", "SYSTEM=C"),
        ":4: *NODE gives coordinates in a local system"},
       {"another system", changed("*NODE,", "*SYSTEM\n0, 0, 1\n*NODE,"), ":5: *SYSTEM gives coordinates"},
       {"bad range", changed("2, 20, 2", "20, 2, 2"), line_of("2, 20, 2") + "the range 20 to 2 is empty"},
       {"long range", changed("2, 20, 2", "2, 20, 2, 1"), "a line of GENERATE has first, last and step"},
       {"huge member", changed("1, 14,\n3\n", "1, 14,\n3000000000\n"), "the number 3000000000 is too large"},
       {"binary", std::string("*NODE\n1\0, 0\n", 12), "is not a text file"}});
  const Mesh sparse = read_deck(with(std::string(kDeck), "2, 20, 2", "2, 999999999999, 2"));
  EXPECT_EQ(set_of(sparse, "even").members.size(), 3U) << "in time proportional to the elements";
}

/// A deck long enough to be read by all threads: tetrahedra along a helix.
std::string long_deck() {
  constexpr int kNodes = 6000;
  std::string nodes = "*NODE, NSET=all\n";
  std::string elements = "*ELEMENT, TYPE=C3D4, ELSET=body\n";
  for (int k = 1; k <= kNodes; ++k) {
    nodes += fmt::format("{}, {}, {}, {}\n", k, std::cos(0.1 * k), std::sin(0.1 * k), 1e-3 * k);
    if (k > 3) elements += fmt::format("{0}, {1}, {2}, {3}, {0}\n", k, k - 3, k - 2, k - 1);
  }
  return nodes + elements + "*NSET, NSET=some\n1, 5000\n*STEP\n*END STEP\n";
}

TEST(Abaqus, ReadsLongDecksOnAllThreadsAsLineByLine) {
  struct Case {
    const char* name;
    const char* old;
    const char* fresh;
    bool is_broken = false;
  };
  constexpr std::array kCases{
      Case{"as it is", "*STEP", "*STEP"},
      Case{"a comment between", "\n4500, ", "\n** half way\n4500, "},
      Case{"a blank line", "\n4500, ", "\n\n \t\n4500, "},
      Case{"another number", "\n4500, ", "\n7000, 1, 2, 3\n4500, "},
      Case{"a real number of Fortran", "\n4500, ", "\n7000, 1.D0, 2, 3\n4500, "},
      Case{"two coordinates", "\n4500, ", "\n7000, 1, 2\n4500, "},
      Case{"more than coordinates", "\n4500, ", "\n7000, 1, 2, 3, 4, 5\n4500, "},
      Case{"an element on two lines", "\n4501, 4498, ", "\n4501, 4498,\n "},
      Case{"a comma at the end", "\n4501, 4498, 4499, 4500, 4501", "\n4501, 4498, 4499, 4500, 4501,"},
      Case{"numbers after the nodes", "\n4501, 4498, 4499, 4500, 4501", "\n4501, 4498, 4499, 4500, 4501, 7"},
      Case{"a node that comes later", "*NSET, NSET=some", "*NODE\n6001, 0, 0, 0\n*NSET, NSET=some"},
      Case{"a cut line", "\n4501, 4498, 4499, 4500, 4501", "\n4501, 4498, 4499", true},
      Case{"a node twice", "\n4500, ", "\n4499, ", true},
      Case{"an element twice", "\n4501, 4498, 4499,", "\n4500, 4498, 4499,", true},
      Case{"a word", "\n4500, ", "\n4500, one, ", true},
      Case{"no such node", "\n4501, 4498, ", "\n4501, 9999, ", true},
      Case{"a huge number", "\n4501, 4498, ", "\n4501, 44444444444, ", true},
  };
  for (const Case& test : kCases) {
    std::string text = with(long_deck(), test.old, test.fresh);
    if (std::string_view(test.name).ends_with("later")) text = with(text, "\n4501, 4498, ", "\n4501, 6001, ");
    for (const std::string_view end : {"\n", "\r\n"}) {
      SCOPED_TRACE(fmt::format("{}, {} bytes a line's end", test.name, end.size()));
      if (end == "\r\n") {
        std::string pairs;
        for (const char c : text) pairs.append(c == '\n' ? end : std::string_view(&c, 1));
        text = pairs;
      }
      // after a number of Fortran, lines are read one by one
      const auto read = [](const std::string& deck) -> std::pair<Mesh, std::string> {
        const TemporaryFolder folder;
        try {
          return {read_mesh(folder.file("m.inp", deck)), ""};
        } catch (const Error& error) {
          return {Mesh(), std::string(error.what()).substr(std::string(error.what()).find("m.inp"))};
        }
      };
      const auto [expected, expected_fault] =
          read(with(text, "0.9950041652780258,", "0.9950041652780258D0,"));
      const auto [actual, fault] = read(text);
      EXPECT_EQ(fault, expected_fault);
      EXPECT_EQ(fault.empty(), !test.is_broken) << fault;
      test::expect_same(actual, expected);
    }
  }
}

TEST(Abaqus, NoticesATruncatedMesh) {
  // no cards after the mesh: each cut is within the mesh
  const std::string mesh(kDeck.substr(0, kDeck.find("*NSET")));
  for (std::size_t length = 0; length < mesh.size(); length += 3) {
    const TemporaryFolder folder;
    try {
      (void)read_mesh(folder.file("m.inp", std::string_view(mesh).substr(0, length)));
    } catch (const Error&) {  // one clear error; no crash
    }
  }
}

TEST(Abaqus, FindsNumbersInCards) {
  const auto numbers = [](const std::string& text) {
    std::string result;
    const auto found = abaqus::references(abaqus::parse_card(text), text);
    if (!found) return std::string("unknown");
    for (const abaqus::Reference& reference : *found) {
      result += reference.association == Association::vertices ? 'n' : 'e';
      result += text.substr(reference.begin, reference.length) + " ";
    }
    return result;
  };
  EXPECT_EQ(numbers("*boundary, OP=NEW\n 12, 1, 3\nleft, 2\n13,4\n"), "n12 n13 ");
  EXPECT_EQ(numbers("*SURFACE, NAME=a\n12, S1\n"), "e12 ");
  EXPECT_EQ(numbers("*SURFACE, NAME=a, TYPE=NODE\n12\n"), "n12 ");
  EXPECT_EQ(numbers("*SURFACE, NAME=a, TYPE=CUTTING SURFACE\n12\n"), "unknown");
  EXPECT_EQ(numbers("*EQUATION\n3\n1,2,0.5,2,2,\n0.5,3,2,1\n2\n4,1,1,5,1,1"), "n1 n2 n3 n4 n5 ");
  EXPECT_EQ(numbers("*EQUATION\n4\n1,1,1., 2,1,-1., \n3,1,1., 4,1,2.\n"), "n1 n2 n3 n4 ")
      << "a blank behind the comma at the end of a line";
  EXPECT_EQ(numbers("*EQUATION, REMOVE\n5, 1, 3\n6, 1\n"), "n5 n6 ");
  EXPECT_EQ(numbers("*MPC\nTIE, 12, left, 4\n"), "n12 n4 ");
  EXPECT_EQ(numbers("*MPC\nTIE, left, right\n"), "unknown") << "pairs by the order of the numbers";
  EXPECT_EQ(numbers("*EQUATION\n2\nleft, 1, 1., right, 1, -1.\n"), "unknown");
  EXPECT_EQ(numbers("*EQUATION\n2\nleft, 1, 1., beam-1.12, 1, -1.\n"), "n12 ");
  EXPECT_EQ(numbers("*INITIAL CONDITIONS, TYPE=TEMPERATURE\n12, 20\n"), "n12 ");
  EXPECT_EQ(numbers("*INITIAL CONDITIONS, TYPE=STRESS\n12, 1, 20\n"), "e12 ");
  EXPECT_EQ(numbers("*INITIAL CONDITIONS, TYPE=SOLUTION\n12, 1, 20\n"), "unknown");
  EXPECT_EQ(numbers("*DLOAD\n12, P1NP, 7\n3, P1, 7\n"), "e12 n7 e3 ");
  EXPECT_EQ(numbers("*PRE-TENSION SECTION, SURFACE=a, NODE=7\n1, 0, 0\n"), "n7 ");
  EXPECT_EQ(numbers("*PRE-TENSION SECTION, ELEMENT=12, NODE=7\n"), "e12 n7 ");
  EXPECT_EQ(numbers("*STATIC, RIKS\n1., 1., , , , 5, 1, 2.\n"), "n5 ");
  EXPECT_EQ(numbers("*STATIC\n1., 1., , , 5, 5\n"), "");
  EXPECT_EQ(numbers("*CLEARANCE, MASTER=a, SLAVE=b, TABULAR\n12, 0.1\n"), "n12 ");
  EXPECT_EQ(numbers("*CLEARANCE, MASTER=a, SLAVE=b, VALUE=12\n"), "");
  EXPECT_EQ(numbers("*SECTION PRINT, SURFACE=a, NAME=b\nSOF, SOM\n"), "");
  EXPECT_EQ(numbers("*SECTION PRINT, SURFACE=a, NAME=b, AXES=LOCAL\n12, 0., 0., 0.\nSOF\n"), "unknown");
  EXPECT_EQ(numbers("*RIGIDBODY, NSET=a,\n REFNODE = 7, ROTNODE=8\n"), "n7 n8 ");
  EXPECT_EQ(numbers("*RIGID BODY, NSET=a,\n** b, c\n\n REF NODE=7,\n"), "n7 ");
  EXPECT_EQ(numbers("*CLOAD,\n12, 1, 1.\n"), "n12 ");
  EXPECT_EQ(numbers("*CLOAD, \nleft, 1, 1.\n12, 1, 1.\n"), "n12 ");
  EXPECT_EQ(numbers("*CLOAD, OP=NEW,\nFOLLOWER\n12, 1, 1.\n"), "n12 ");
  EXPECT_EQ(numbers("*EQUATION,\nREMOVE\n5, 1, 3\n6, 1\n"), "n5 n6 ");
  EXPECT_EQ(numbers("*NODE PRINT, NSET=a\n1\n"), "");
  EXPECT_EQ(numbers("*NORMAL\n12, 7, 1, 0, 0\n"), "e12 n7 ");
  EXPECT_EQ(numbers("*BOUNDARY, INPUT=file\n"), "unknown");
}

}  // namespace
}  // namespace meshorder
