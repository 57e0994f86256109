// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/gmsh_files.hpp"
#include "support/files.hpp"

#include <gtest/gtest.h>

namespace meshorder::test {
namespace {

/// kGmsh41 or kGmsh22 with one change.
std::string changed(std::string_view file, std::string_view what, std::string_view by) {
  std::string content(file);
  const auto at = content.find(what);
  if (at == std::string::npos) {
    ADD_FAILURE() << "not there: " << what;
    return content;
  }
  return content.replace(at, what.size(), by);
}

std::string in_41(std::string_view what, std::string_view by) { return changed(kGmsh41, what, by); }
std::string in_22(std::string_view what, std::string_view by) { return changed(kGmsh22, what, by); }

/// The text before `where`.
std::string until(std::string_view file, std::string_view where) {
  return std::string(file.substr(0, file.find(where)));
}

TEST(GmshBroken, VersionsThatAreNotReadAreNamed) {
  expect_broken("mesh.msh", {{"version 3", in_22("2.2 0 8", "3 0 8"),
                              ":2: version 3.0 of Gmsh's format is not supported; 1, 2.2, 4.0 and 4.1"},
                             {"says how to convert", in_41("4.1 0 8", "5 0 8"), "gmsh OLD.msh -save"},
                             {"no version", in_41("4.1 0 8", "four"), ":2: the version is 'four'"},
                             {"file type", in_41("4.1 0 8", "4.1 2 8"), ":2: the file type is 2"},
                             {"data size", changed(gmsh_41_binary(std::endian::native), "4.1 1 8", "4.1 1 4"),
                              ":2: the data size is 4"},
                             {"byte order", "$MeshFormat\n4.1 1 8\nabcd\n$EndMeshFormat\n",
                              "byte 24: the number that shows"}});
}

TEST(GmshBroken, FaultsInTextAreNamedWithTheirLine) {
  expect_broken(
      "mesh.msh",
      {{"no sections", "hello\n", "mesh.msh:1: is not a Gmsh file (it begins with 'hello')"},
       {"garbage",
        std::string("\x7f"
                    "ELF\0\1\2",
                    7),
        "is not a Gmsh file"},
       {"an end without a beginning", "$EndNodes\n", ":1: unexpected text outside"},
       {"no format", "$Nodes\n0\n$EndNodes\n", ":2: $Nodes comes before $MeshFormat"},
       {"two formats", std::string(kGmsh41) + "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "a second section"},
       {"two sections of nodes", std::string(kGmsh22) + "$Nodes\n0\n$EndNodes\n", "a second section $Nodes"},
       {"no nodes", until(kGmsh22, "$Nodes"), "the file has no section $Nodes"},
       {"no elements", until(kGmsh22, "$Elements"), "the file has no section $Elements"},
       {"elements first", until(kGmsh22, "$Nodes") + "$Elements\n0\n$EndElements\n",
        "$Elements comes before"},
       {"data first", until(kGmsh22, "$Elements") + "$NodeData\n0\n", "$NodeData comes before $Elements"},
       {"section without an end", until(kGmsh22, "$EndNodes"),
        ":16: unexpected end of file; expected $EndNodes"},
       {"comments without an end", std::string(kGmsh22) + "$Comments\nabc\n",
        "$Comments has no $EndComments"},
       {"names without quotes", in_22("\"rock\"", "rock"), "the name of the physical group 4 has no quotes"},
       {"too many names", in_22("2\n2 7", "3\n2 7"),
        "the dimension of a physical group is '$EndPhysicalNames'"},
       {"an absurd number of names", in_22("2\n2 7", "1000000000000\n2 7"),
        "the number of names is 1000000000000"},
       {"a tag of 33 bits", in_22("2 7", "2 4294967303"), "the tag of a physical group is 4294967303"},
       {"unknown section with numbers", std::string(kGmsh22) + "$Ranks\n1 2 3\n$EndRanks\n",
        "the section $Ranks"},
       {"overlaps", std::string(kGmsh41) + "$Overlaps3D\n1\n1 2 1 1\n9\n$EndOverlaps3D\n", "$Overlaps3D"},
       {"faces", std::string(kGmsh41) + "$Faces\n1 0\n1 2 10 20\n$EndFaces\n", "$Faces"}});
}

TEST(GmshBroken, FaultsOfNodesAreNamed) {
  expect_broken(
      "mesh.msh",
      {{"too many promised", in_22("5\n1 0 0 0", "6\n1 0 0 0"), ":16: the number of a node is '$EndNodes'"},
       {"too few promised", in_22("5\n1 0 0 0", "4\n1 0 0 0"), ":15: $Nodes continues; expected $EndNodes"},
       {"absurd", in_22("5\n1 0 0 0", "1000000000000\n1 0 0 0"), ":10: the number of nodes is 1000000000000"},
       {"large", in_22("5\n1 0 0 0", "2000000000\n1 0 0 0"),
        ":10: the number of nodes is 2000000000, but only"},
       {"negative count", in_22("5\n1 0 0 0", "-5\n1 0 0 0"), ":10: the number of nodes is -5"},
       {"nan", in_22("2 1 0 0", "2 nan 0 0"), ":12: a coordinate is not finite"},
       {"infinite", in_22("2 1 0 0", "2 1 -inf 0"), ":12: a coordinate is not finite"},
       {"no number", in_22("2 1 0 0", "2 1 0 x"), ":12: a coordinate is 'x'"},
       {"given twice", in_22("2 1 0 0", "1 1 0 0"), "node 1 is given twice"},
       {"given twice, sparse", in_22("5 0 0 -1", "1 0 0 -1"), "node 1 is given twice"},
       {"negative number", in_22("2 1 0 0", "-2 1 0 0"), "node -2 has a negative number"},
       {"4.1: given twice", in_41("\n35\n", "\n30\n"), "node 30 is given twice"},
       {"4.1: nan", in_41("0.5 0.5 0.5", "0.5 nan 0.5"), ":36: a coordinate is not finite"},
       {"4.1: absurd", in_41("3 6 2 40", "3 1000000000000 2 40"),
        ":22: the number of nodes is 1000000000000"},
       {"4.1: absurd blocks", in_41("3 6 2 40", "900000000 6 2 40"),
        ":22: the number of blocks is 900000000"},
       {"4.1: absurd block", in_41("3 5 0 3", "3 5 0 99999999999"),
        ":31: the number of nodes in a block is 9999"},
       {"4.1: blocks have more", in_41("3 6 2 40", "3 5 2 40"), "$Nodes have 6 or more instead of 5"},
       {"4.1: blocks have fewer", in_41("3 6 2 40", "2 6 2 40"), "$Nodes have 3 instead of 6"},
       {"4.1: dimension", in_41("0 1 0 1\n2", "4 1 0 1\n2"), ":23: an entity's dimension is 4"},
       {"4.1: parametric", in_41("2 3 1 2\n10", "2 3 7 2\n10"), ":26: 'parametric' is 7"}});
}

TEST(GmshBroken, FaultsOfVersions1And40AreNamed) {
  const auto in_1 = [](std::string_view what, std::string_view by) { return changed(kGmsh1, what, by); };
  const auto in_40 = [](std::string_view what, std::string_view by) { return changed(gmsh_40(), what, by); };
  const std::string binary = gmsh_40_binary(std::endian::native);
  const auto nodes = binary.find("$Nodes\n") + 7;
  expect_broken(
      "mesh.msh",
      {{"no elements", until(kGmsh1, "$ELM"), "the file has no section $Elements"},
       {"number of nodes", in_1("2 4 4 5 4 1", "2 4 4 5 3 1"),
        ":12: element 2 has 3 nodes; elements of type 4 have 4"},
       {"more nodes", in_1("NOD\n5", "NOD\n4"), ":7: $NOD continues; expected $ENDNOD"},
       {"the next section", in_1("$ENDNOD\n", ""), ":8: expected $ENDNOD, found $ELM"},
       {"version 1 in version 4", std::string(kGmsh41) + "$NOD\n0\n$ENDNOD\n", "a second section $NOD"},
       {"node out of range", in_40("7 2 10 20 30", "7 2 10 20 31"), "element 7 names node 31"},
       {"dimension", in_40("3 2 1 2\n10", "3 4 1 2\n10"), "an entity's dimension is 4"},
       {"blocks have more", in_40("3 6\n1 0 0 1", "3 5\n1 0 0 1"), "$Nodes have 6 or more instead of 5"},
       {"absurd nodes", std::string(binary).replace(nodes + 8, 8, std::string(8, '\x11')),
        "the number of nodes is 1229782938247303441"},
       {"cut", binary.substr(0, nodes + 100), "the number of nodes is 6, but only 84 bytes follow"}});
}

TEST(GmshBroken, FaultsOfElementsAreNamed) {
  expect_broken(
      "mesh.msh",
      {{"node out of range", in_22("3 2 2 7 3 1 2 3", "3 2 2 7 3 1 2 6"), ":21: element 3 names node 6"},
       {"node 0", in_22("3 2 2 7 3 1 2 3", "3 2 2 7 3 1 2 0"), ":21: element 3 names node 0"},
       {"negative node", in_22("3 2 2 7 3 1 2 3", "3 2 2 7 3 1 2 -3"), ":21: element 3 names node -3"},
       {"no node", in_22("3 2 2 7 3 1 2 3", "3 2 2 7 3 1 2 x"), ":21: a node of an element is 'x'"},
       {"type", in_22("3 2 2 7 3 1 2 3", "3 0 2 7 3 1 2 3"), ":21: the element type 0 is not supported"},
       {"polygon", in_22("3 2 2 7 3 1 2 3", "3 34 2 7 3 1 2 3"), ":21: the element type 34 is not supported"},
       {"tags", in_22("3 2 2 7 3 1 2 3", "3 2 -2 7 3 1 2 3"), ":21: the number of tags is -2"},
       {"absurd tags", in_22("3 2 2 7 3 1 2 3", "3 2 1000000 7 3 1 2 3"),
        ":21: the number of tags is 1000000"},
       {"parent", in_22("2 4 4 4 5 1 2", "2 4 5 4 5 1 2 1"),
        ":20: an element has more tags than its partitions"},
       {"given twice", in_22("3 2 2 7 3 1 2 3", "1 2 2 7 3 1 2 3"), "element 1 is given twice"},
       {"absurd", in_22("4\n1 15", "1000000000000\n1 15"), ":18: the number of elements is 1000000000000"},
       {"too many promised", in_22("4\n1 15", "5\n1 15"), ":23: the number of an element is '$EndElements'"},
       {"zero cells", until(kGmsh22, "$Elements") + "$Elements\n0\n$EndElements\n", "has no cells"},
       {"4.1: node", in_41("7 2 10 20 30", "7 2 10 20 31"), ":44: element 7 names node 31"},
       {"4.1: huge node", in_41("7 2 10 20 30", "7 2 10 20 99999999999999999"),
        ":44: element 7 names node 9999"},
       {"4.1: type", in_41("3 5 4 1\n7", "3 5 35 1\n7"), ":43: the element type 35 is not supported"},
       {"4.1: absurd", in_41("3 3 3 9", "3 1000000000000 3 9"),
        ":40: the number of elements is 1000000000000"},
       {"4.1: absurd block", in_41("3 5 4 1\n7", "3 5 4 9999999\n7"),
        ":43: the number of elements in a block"},
       {"4.1: more", in_41("3 3 3 9", "3 2 3 9"), "$Elements have 3 or more instead of 2"},
       {"4.1: given twice", in_41("9 2 20 10 40", "7 2 20 10 40"), "element 7 is given twice"},
       {"4.1: zero cells", until(kGmsh41, "$Elements") + "$Elements\n0 0 0 0\n$EndElements\n",
        "has no cells"},
       {"4.1: absurd entities", in_41("1 1 1 2\n", "1 1 900000000 2\n"),
        ":14: a number of entities is 900000000"},
       {"4.1: no entity", in_41("6 0 0 0 1 1 2 1 9 0\n", ""), ":19: an entity's tag is '$EndEntities'"}});
}

TEST(GmshBroken, FaultsOfWhatIsAttachedAreNamed) {
  expect_broken(
      "mesh.msh",
      {{"unknown node", in_41("35 5.5", "36 5.5"), "$NodeData names node 36, which the file does not have"},
       {"unknown element", in_22("4 3.5", "5 3.5"), "$ElementData names element 5, which the file does not"},
       {"twice", in_41("35 5.5", "30 5.5"), "$NodeData gives the same node or element twice"},
       {"few integer tags", in_22("3\n0\n1\n4\n1 0.5", "2\n0\n1\n4\n1 0.5"),
        "$ElementData has 2 integer tags"},
       {"components", in_22("3\n0\n1\n4\n1 0.5", "3\n0\n0\n4\n1 0.5"), ":37: the number of components is 0"},
       {"absurd", in_22("3\n0\n1\n4\n1 0.5", "3\n0\n1\n400000000\n1 0.5"),
        "the number of entries is 400000000"},
       {"absurd strings", in_22("1\n\"stress\"", "999999\n\"stress\""), "string tags is 999999"},
       {"no value", in_22("4 3.5", "4 x"), ":42: a value is 'x'"},
       {"nodes of an entry", in_41("7 4 4 5 6 7", "7 2 4 5"),
        "gives elements other numbers of nodes than they have"},
       {"absurd nodes of an entry", in_41("7 4 4 5 6 7", "7 99999999 4 5"),
        "the number of nodes of an entry is"},
       {"ghost", in_41("9 1 2 3 4", "8 1 2 3 4"), "$GhostElements names element 8"},
       {"absurd ghosts", in_41("9 1 2 3 4", "9 1 2000000000 3 4"),
        "the number of ghost partitions is 2000000000"},
       {"absurd periodic", in_41("2\n10 2\n", "2000000000\n10 2\n"),
        "the number of periodic nodes is 2000000000"},
       {"absurd affine", in_41("16 1 0 0 0", "1600000 1 0 0 0"),
        "the number of affine coefficients is 1600000"},
       {"periodic twice",
        in_22("1\n0 1 2\nAffine 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n1\n2 1\n",
              "2\n0 1 2\n1\n2 1\n0 1 2\n1\n2 1\n"),
        "the periodic entity 1 of dimension 0 is given twice"}});
}

TEST(GmshBroken, FaultsInBinaryAreNamedWithTheirByte) {
  const std::string file = gmsh_41_binary(std::endian::native);
  const auto nodes = file.find("$Nodes\n") + 7;
  const auto elements = file.find("$Elements\n") + 10;
  const auto with = [&](std::size_t at, std::string_view bytes) {
    return std::string(file).replace(at, bytes.size(), bytes);
  };
  const std::string many(8, '\x11');
  const std::string all_set(8, '\xff');
  expect_broken(
      "mesh.msh",
      {{"absurd blocks", with(nodes, many), "byte " + std::to_string(nodes + 8) + ": the number of blocks"},
       {"absurd nodes", with(nodes + 8, many), "the number of nodes is 1229782938247303441"},
       {"negative nodes", with(nodes + 8, all_set), "the number of nodes is -1; it cannot be negative"},
       {"nan", with(nodes + 60, all_set), "a coordinate is not finite"},
       {"unknown node", with(elements + 60, many), "names node 1229782938247303441"},
       {"element type", with(elements + 40, many), "the element type 286331153 is not supported"},
       {"cut", file.substr(0, nodes + 100), "the number of nodes is 6, but only 84 bytes follow"},
       {"garbage", file.substr(0, nodes) + std::string(300, '\x5a'), "the number of blocks"}});
}

TEST(GmshBroken, FoldersAndEmptyFilesAreNamed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "folder.msh");
  EXPECT_NE(read_error(folder.path() / "folder.msh").find("is a folder"), std::string::npos);
  EXPECT_NE(read_error(folder.file("empty.msh", "")).find("is empty"), std::string::npos);
  EXPECT_NE(read_error(folder.file("blank.msh", "\n\n")).find("no section $MeshFormat"), std::string::npos);
}

TEST(GmshBroken, TruncationIsNoticed) {
  for (const std::string& content :
       {std::string(kGmsh41), std::string(kGmsh22), std::string(kGmsh1), gmsh_40(),
        gmsh_40_binary(std::endian::native), gmsh_41_binary(std::endian::native),
        gmsh_41_binary(std::endian::big), gmsh_22_binary(std::endian::native)}) {
    expect_truncation_is_noticed("mesh.msh", content);
  }
}

}  // namespace
}  // namespace meshorder::test
