// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

/// Small Gmsh files with all that such files may contain, as Gmsh itself writes them.
namespace meshorder::test {

/// Two tetrahedra and a triangle in separate entities, six nodes in blocks of three entities, sparse numbers,
/// one unused node, and one of every section.
inline constexpr std::string_view kGmsh41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Comments
node 1 is 2, they say
$EndComments
$PhysicalNames
3
2 7 "inlet"
3 4 "rock"
3 9 "all of it"
$EndPhysicalNames
$Entities
1 1 1 2
1 0 0 0 0
1 0 0 0 1 0 0 0 2 1 -2
3 0 0 0 1 1 0 1 7 0
5 0 0 0 1 1 1 2 4 9 1 3
6 0 0 0 1 1 2 1 9 0
$EndEntities
$Nodes
3 6 2 40
0 1 0 1
2
0 0 0
2 3 1 2
10
20
1 0 0 0.5 0.25
0 1 0 0.75 0.125
3 5 0 3
30
35
40
0 0 1
0.5 0.5 0.5
0 0 -1
$EndNodes
$Elements
3 3 3 9
2 3 2 1
3 2 10 20
3 5 4 1
7 2 10 20 30
3 6 4 1
9 2 20 10 40
$EndElements
$Periodic
1
2 3 8
16 1 0 0 0 0 1 0 0 0 0 1 0.5 0 0 0 1
2
10 2
20 30
$EndPeriodic
$GhostElements
1
9 1 2 3 4
$EndGhostElements
$NodeData
1
"heat"
1
0
3
0
1
6
2 1.5
10 2.5
20 3.5
30 4.5
35 5.5
40 6.5
$EndNodeData
$NodeData
1
"heat"
1
0.25
4
1
3
2
0
40 1 2 3
10 4 5 6
$EndNodeData
$ElementData
2
"stress"
"a scheme"
1
0
3
0
1
1
9 -1.25
$EndElementData
$ElementNodeData
1
"jump"
1
0
3
0
1
2
3 3 1 2 3
7 4 4 5 6 7
$EndElementNodeData
)";

/// A similar mesh in version 2.2, with different numbers of tags, and with mixed types and dimensions.
inline constexpr std::string_view kGmsh22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 7 "inlet"
3 4 "rock"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 0 -1
$EndNodes
$Elements
4
1 15 2 0 1 1
2 4 4 4 5 1 2 1 2 3 4
3 2 2 7 3 1 2 3
4 4 5 9 6 2 1 -2 1 3 2 5
$EndElements
$Periodic
1
0 1 2
Affine 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1
1
2 1
$EndPeriodic
$ElementData
1
"stress"
0
3
0
1
4
1 0.5
2 1.5
3 2.5
4 3.5
$EndElementData
)";

/// The mesh of kGmsh22 with the two tags that elements have in version 1.
inline constexpr std::string_view kGmsh1 = R"($NOD
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 0 -1
$ENDNOD
$ELM
4
1 15 0 1 1 1
2 4 4 5 4 1 2 3 4
3 2 7 3 3 1 2 3
4 4 9 6 4 1 3 2 5
$ENDELM
)";

/// The file kGmsh41 in version 4.0.
inline std::string gmsh_40() {
  std::string content(kGmsh41);
  const auto replace = [&](std::string_view what, std::string_view by) {
    content.replace(content.find(what), what.size(), by);
  };
  const auto replace_section = [&](std::string_view name, std::string_view by) {
    const std::size_t begin = content.find("$" + std::string(name) + "\n") + name.size() + 2;
    content.replace(begin, content.find("$End" + std::string(name)) - begin, by);
  };
  replace("4.1 0 8", "4 0 8");
  replace("1 0 0 0 0\n", "1 0 0 0 0 0 0 0\n");  // a point has two corners, too
  replace_section("Nodes",
                  "3 6\n1 0 0 1\n2 0 0 0\n3 2 1 2\n10 1 0 0 0.5 0.25\n20 0 1 0 0.75 0.125\n"
                  "5 3 0 3\n30 0 0 1\n35 0.5 0.5 0.5\n40 0 0 -1\n");
  replace_section("Elements", "3 3\n3 2 2 1\n3 2 10 20\n5 3 4 1\n7 2 10 20 30\n6 3 4 1\n9 2 20 10 40\n");
  replace("16 1 0 0 0", "Affine 1 0 0 0");
  return content;
}

/// Puts together binary files in either byte order.
class Bytes {
 public:
  explicit Bytes(std::endian order) : order_(order) {}

  Bytes& text(std::string_view text) {
    content_ += text;
    return *this;
  }
  template <class T, class... Numbers>
  Bytes& numbers(Numbers... values) {
    (number(static_cast<T>(values)), ...);
    return *this;
  }
  template <class... Numbers>
  Bytes& ints(Numbers... values) {
    return numbers<std::int32_t>(values...);
  }
  template <class... Numbers>
  Bytes& sizes(Numbers... values) {
    return numbers<std::uint64_t>(values...);
  }
  template <class... Numbers>
  Bytes& reals(Numbers... values) {
    return numbers<double>(values...);
  }
  [[nodiscard]] const std::string& content() const { return content_; }

 private:
  template <class T>
  void number(T value) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    content_.append(raw.data(), raw.size());
  }

  std::endian order_;
  std::string content_;
};

/// The mesh of kGmsh41 with most of its sections, in binary.
inline std::string gmsh_41_binary(std::endian order) {
  Bytes file(order);
  file.text("$MeshFormat\n4.1 1 8\n").ints(1).text("\n$EndMeshFormat\n");
  file.text("$PhysicalNames\n1\n3 4 \"rock\"\n$EndPhysicalNames\n$Entities\n").sizes(1, 0, 1, 2);
  file.ints(1).reals(0, 0, 0).sizes(0);
  file.ints(3).reals(0, 0, 0, 1, 1, 0).sizes(1).ints(7).sizes(0);
  file.ints(5).reals(0, 0, 0, 1, 1, 1).sizes(2).ints(4, 9).sizes(1).ints(3);
  file.ints(6).reals(0, 0, 0, 1, 1, 2).sizes(1).ints(9).sizes(0).text("\n$EndEntities\n$Nodes\n");
  file.sizes(3, 6, 2, 40).ints(0, 1, 0).sizes(1).sizes(2).reals(0, 0, 0);
  file.ints(2, 3, 1).sizes(2).sizes(10, 20).reals(1, 0, 0, 0.5, 0.25).reals(0, 1, 0, 0.75, 0.125);
  file.ints(3, 5, 0).sizes(3).sizes(30, 35, 40).reals(0, 0, 1, 0.5, 0.5, 0.5, 0, 0, -1);
  file.text("\n$EndNodes\n$Elements\n").sizes(3, 3, 3, 9);
  file.ints(2, 3, 2).sizes(1).sizes(3, 2, 10, 20);
  file.ints(3, 5, 4).sizes(1).sizes(7, 2, 10, 20, 30);
  file.ints(3, 6, 4).sizes(1).sizes(9, 2, 20, 10, 40).text("\n$EndElements\n$Periodic\n");
  file.sizes(1).ints(2, 3, 8).sizes(1).reals(0.5).sizes(2).sizes(10, 2, 20, 30);
  file.text("\n$EndPeriodic\n$GhostElements\n").sizes(1, 9).ints(1).sizes(2).ints(3, 4);
  file.text("\n$EndGhostElements\n$ElementData\n1\n\"stress\"\n1\n0\n3\n0\n3\n2\n");
  file.ints(9).reals(1.5, 2.5, 3.5).ints(3).reals(4.5, 5.5, 6.5);
  file.text("\n$EndElementData\n$ElementNodeData\n1\n\"jump\"\n1\n0\n3\n0\n1\n1\n");
  return file.ints(3, 3).reals(1, 2, 3).text("\n$EndElementNodeData\n").content();
}

/// The same in version 4.0, as Gmsh 4.0 writes it.
inline std::string gmsh_40_binary(std::endian order) {
  Bytes file(order);
  file.text("$MeshFormat\n4 1 8\n").ints(1).text("\n$EndMeshFormat\n");
  file.text("$PhysicalNames\n1\n3 4 \"rock\"\n$EndPhysicalNames\n$Entities\n").sizes(1, 0, 1, 2);
  file.ints(1).reals(0, 0, 0, 0, 0, 0).sizes(0);
  file.ints(3).reals(0, 0, 0, 1, 1, 0).sizes(1).ints(7).sizes(0);
  file.ints(5).reals(0, 0, 0, 1, 1, 1).sizes(2).ints(4, 9).sizes(1).ints(3);
  file.ints(6)
      .reals(0, 0, 0, 1, 1, 2)
      .sizes(1)
      .ints(9)
      .sizes(0)
      .text("\n$EndEntities\n$PartitionedEntities\n");
  file.ints(2, 1, 8, 2).sizes(0, 0, 0, 1);  // partitions, ghosts, and a volume in one partition
  file.ints(5, 3, 6, 1, 2).reals(0, 0, 0, 1, 1, 1).sizes(2).ints(4, 9).sizes(1).ints(3);
  file.text("\n$EndPartitionedEntities\n$Nodes\n");
  file.sizes(3, 6).ints(1, 0, 0).sizes(1).ints(2).reals(0, 0, 0);
  file.ints(3, 2, 1).sizes(2).ints(10).reals(1, 0, 0, 0.5, 0.25).ints(20).reals(0, 1, 0, 0.75, 0.125);
  file.ints(5, 3, 1).sizes(3).ints(30).reals(0, 0, 1).ints(35).reals(0.5, 0.5, 0.5).ints(40).reals(0, 0, -1);
  file.text("\n$EndNodes\n$Elements\n").sizes(3, 3);
  file.ints(3, 2, 2).sizes(1).ints(3, 2, 10, 20);
  file.ints(5, 3, 4).sizes(1).ints(7, 2, 10, 20, 30);
  file.ints(6, 3, 4).sizes(1).ints(9, 2, 20, 10, 40).text("\n$EndElements\n$Periodic\n");
  file.ints(2, 2, 3, 8).numbers<std::int64_t>(-1).reals(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1);
  file.sizes(2).ints(10, 2, 20, 30).ints(0, 1, 2).sizes(1).ints(2, 10);
  file.text("\n$EndPeriodic\n$GhostElements\n")
      .ints(1, 9, 1, 2, 3, 4)
      .text("\n$EndGhostElements\n$ElementData\n");
  file.text("1\n\"stress\"\n1\n0\n3\n0\n3\n2\n").ints(9).reals(1.5, 2.5, 3.5).ints(3).reals(4.5, 5.5, 6.5);
  return file.text("\n$EndElementData\n").content();
}

/// The mesh of kGmsh22 with its tags, in binary.
inline std::string gmsh_22_binary(std::endian order) {
  Bytes file(order);
  file.text("$MeshFormat\n2.2 1 8\n").ints(1).text("\n$EndMeshFormat\n$Nodes\n5\n");
  file.ints(1).reals(0, 0, 0).ints(2).reals(1, 0, 0).ints(3).reals(0, 1, 0);
  file.ints(4).reals(0, 0, 1).ints(5).reals(0, 0, -1).text("\n$EndNodes\n$Elements\n4\n");
  file.ints(15, 1, 2).ints(1, 0, 1, 1).ints(2, 1, 2).ints(2, 7, 3, 1, 2, 3);
  file.ints(4, 2, 4).ints(3, 4, 5, 1, 2, 1, 2, 3, 4).ints(4, 9, 6, 1, 1, 1, 3, 2, 5);
  file.text(
      "\n$EndElements\n$Periodic\n1\n0 1 2\n1\n2 "
      "1\n$EndPeriodic\n$NodeData\n1\n\"heat\"\n1\n0\n3\n0\n1\n1\n");
  return file.ints(4).reals(0.1).text("\n$EndNodeData\n").content();
}

}  // namespace meshorder::test
