// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/cgns.hpp"

#include "io/cgns/tree.hpp"
#include "support/files.hpp"
#include "support/refusal.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;

/// The bytes of an ADF file, the older kind of CGNS file.
std::string adf_file() {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.cgns";
  write_mesh(test::tetrahedral_bar(1), path);
  cgns::Tree tree = cgns::read_tree(path);
  tree.storage = cgns::Storage::adf;
  cgns::write_tree(tree, path, [](cgns::Node& /*node*/) {});
  return test::content_of(path);
}

/// Returns the ADF file as a 64-bit libcgns writes it, with binary pointers and dimensions.
std::string with_binary_pointers(std::string file) {
  const auto dimension = [&](std::size_t at) {
    const std::uint64_t number = std::stoull(file.substr(at, 8), nullptr, 16);
    std::memcpy(file.data() + at, &number, sizeof number);
  };
  const auto pointers = [&](std::size_t at, int count) {
    for (; count > 0; --count, at += 12) {
      dimension(at);
      const auto byte = static_cast<std::uint32_t>(std::stoul(file.substr(at + 8, 4), nullptr, 16));
      std::memcpy(file.data() + at + 8, &byte, sizeof byte);
    }
  };
  const auto each = [&](std::string_view tag, const auto& convert) {
    for (std::size_t at = file.find(tag); at != std::string::npos; at = file.find(tag, at + 4)) convert(at);
  };
  each("NoDe", [&](std::size_t at) {
    for (std::size_t k = 0; k < 12; ++k) dimension(at + 130 + 8 * k);
    pointers(at + 84, 1);
    pointers(at + 230, 1);
  });
  each("SNTb", [&](std::size_t at) {
    pointers(at + 4, 1);
    for (std::size_t entry = at + 16; file.compare(entry, 4, "snTE") != 0; entry += 44)
      pointers(entry + 32, 1);
  });
  each("DaTa", [&](std::size_t at) { pointers(at + 4, 1); });
  each("fCbt", [&](std::size_t at) { pointers(at + 4, 6); });
  each("FreE", [&](std::size_t at) { pointers(at + 4, 2); });
  pointers(134, 4);
  file[25] = 'B';
  return file;
}

TEST(Cgns, MakesTheSameSetsOfSectionsInAnyOrder) {
  const TemporaryFolder folder;
  // a set has one cell of a section: the first section of the file, or another
  write_mesh(test::mixed_mesh(), folder.path() / "a.cgns");
  Mesh mesh = read_mesh(folder.path() / "a.cgns");
  const std::size_t sets = mesh.sets.size();
  apply_reordering(mesh, test::shuffled(mesh.vertex_count(), 1), test::shuffled_cells(mesh, 2));
  write_mesh(mesh, folder.path() / "b.cgns");
  EXPECT_EQ(read_mesh(folder.path() / "b.cgns").sets.size(), sets);
}

/// Returns the node of that name below another; null if there is none.
cgns::Node* find_node(cgns::Node& node, const std::string& name) {
  if (node.name == name) return &node;
  for (cgns::Node& child : node.children) {
    if (cgns::Node* const found = find_node(child, name)) return found;
  }
  return nullptr;
}

TEST(Cgns, DataOfARegionGoWithTheMembersOfItsCondition) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.cgns";
  write_mesh(test::tetrahedral_bar(2), path);
  const auto number = [](const Mesh& mesh) {
    return std::find_if(mesh.sets.begin(), mesh.sets.end(),
                        [](const EntitySet& set) { return set.name == "fixed"; }) -
           mesh.sets.begin();
  };
  Mesh mesh = read_mesh(path);
  cgns::Tree tree = cgns::read_tree(path);
  cgns::Node region = cgns::integer_node("Region", "ZoneSubRegion_t", {2});
  region.children.push_back(cgns::text_node("BCRegionName", "Descriptor_t", "fixed"));
  region.children.push_back(cgns::integer_node(
      "Heat", "DataArray_t", std::vector<std::int32_t>(mesh.sets[number(mesh)].members.size(), 5)));
  find_node(tree.root, "Zone")->children.push_back(std::move(region));
  cgns::write_tree(tree, path, [](cgns::Node& /*node*/) {});

  const auto written = [&](Notes& notes) {
    write_mesh(mesh, folder.path() / "b.cgns", &notes);
    return cgns::read_tree(folder.path() / "b.cgns");
  };
  mesh = read_mesh(path);
  Notes notes;
  tree = written(notes);
  EXPECT_NE(find_node(tree.root, "Heat"), nullptr);
  EXPECT_TRUE(notes.empty());
  mesh.sets[number(mesh)].members.pop_back();
  tree = written(notes);
  EXPECT_NE(find_node(tree.root, "Region"), nullptr);
  EXPECT_EQ(find_node(tree.root, "Heat"), nullptr);
  EXPECT_EQ(notes, Notes{"the data of 'Region' are left out: 'fixed' has other members now"});
  notes.clear();
  mesh.sets.erase(mesh.sets.begin() + number(mesh));
  tree = written(notes);
  EXPECT_EQ(find_node(tree.root, "Region"), nullptr);
  EXPECT_EQ(notes, Notes{"the region 'Region' is left out: it belongs to 'fixed', which has no members"});
}

TEST(Cgns, WhatItsTypeCannotHoldIsWrittenInAWiderOne) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.cgns";
  Mesh mesh = test::tetrahedral_bar(1);
  const std::size_t points = mesh.points.size();
  mesh.data = {{"real", Association::vertices, 1, std::vector<float>(points, 0.5F), {}, {}},
               {"whole", Association::vertices, 1, std::vector<std::int32_t>(points, 7), {}, {}},
               {"same", Association::vertices, 1, std::vector<float>(points, 0.5F), {}, {}}};
  write_mesh(mesh, path);
  cgns::Tree tree = cgns::read_tree(path);
  for (const char* const axis : {"CoordinateX", "CoordinateY", "CoordinateZ"}) {
    cgns::Node& node = *find_node(tree.root, axis);
    std::vector<double> values(points);
    std::memcpy(values.data(), node.bytes.data(), node.bytes.size());
    const std::vector<float> singles(values.begin(), values.end());
    node.type = "R4";
    node.bytes.resize(points * sizeof(float));
    std::memcpy(node.bytes.data(), singles.data(), node.bytes.size());
  }
  cgns::write_tree(tree, path, [](cgns::Node& /*node*/) {});
  mesh = read_mesh(path);
  mesh.points[1][0] = 0.1;
  const auto fill = [&](const char* name, Values values) {
    for (DataArray& array : mesh.data) {
      if (array.name == name) array.values = std::move(values);
    }
  };
  std::vector<double> reals(points, 0.1);
  reals[0] = 1e165;
  fill("real", reals);
  fill("whole", std::vector<double>(points, 2147483648.0));
  fill("same", std::vector<double>(points, 0.25));
  write_mesh(mesh, path);
  tree = cgns::read_tree(path);
  for (const auto& [name, type] : std::vector<std::pair<std::string, std::string>>{
           {"CoordinateX", "R8"}, {"CoordinateY", "R4"}, {"real", "R8"}, {"whole", "I8"}, {"same", "R4"}}) {
    EXPECT_EQ(find_node(tree.root, name)->type, type) << name;
  }
  const Mesh back = read_mesh(path);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_EQ(find_array(back, "real", Association::vertices)->values, Values(reals));
  EXPECT_EQ(find_array(back, "whole", Association::vertices)->values,
            Values(std::vector<std::int64_t>(points, 2147483648)));
}

TEST(Cgns, ReadsFilesOfAdf) {
  const TemporaryFolder folder;
  write_mesh(test::tetrahedral_bar(1), folder.path() / "a.cgns");
  const Mesh expected = read_mesh(folder.path() / "a.cgns");
  test::expect_same(read_mesh(folder.file("b.cgns", adf_file())), expected);
  test::expect_same(read_mesh(folder.file("c.cgns", with_binary_pointers(adf_file()))), expected);
}

TEST(Cgns, RefusesBinaryPointersOfAdfThatLeadElsewhere) {
  const std::string file = with_binary_pointers(adf_file());
  const TemporaryFolder folder;
  const std::string far(8, '\x7f');
  const std::string beyond = "lies beyond the end of the file";
  for (const auto& [what, at, fresh, expected] :
       std::vector<std::tuple<std::string, std::size_t, std::string, std::string>>{
           {"the root", 134, far, beyond},
           {"a byte in a block", 134 + 8, far.substr(4), beyond},
           {"children", file.find("NoDe") + 84, far, beyond},
           {"a child", file.find("SNTb") + 48, far, beyond},
           {"the end of values", file.find("DaTa") + 4, std::string(12, '\0'),
            "values end before they begin"},
           {"the byte order", 100, "N", "the byte order is unknown"}}) {
    std::string broken = file;
    broken.replace(at, fresh.size(), fresh);
    const std::string message = test::read_error(folder.file("b.cgns", broken));
    EXPECT_NE(message.find(expected), std::string::npos) << what << ": " << message;
  }
}

TEST(Cgns, RefusesElementTypesByTheirNumbersInVersion30) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.cgns";
  const auto write_as_30 = [&](const Mesh& mesh) {
    write_mesh(mesh, path);
    cgns::Tree tree = cgns::read_tree(path);
    const float version = 3.0F;
    std::memcpy(tree.root.child_of_label("CGNSLibraryVersion_t")->bytes.data(), &version, sizeof version);
    cgns::write_tree(tree, path, [](cgns::Node& /*node*/) {});
  };
  write_as_30(test::tetrahedral_bar(1));  // the type number of tetrahedra was the same in 3.0
  EXPECT_EQ(read_mesh(path).cell_count(), test::tetrahedral_bar(1).cell_count());
  write_as_30(test::cells_of_type(Shape::hexahedron, 8, 2));
  const std::string message = test::read_error(path);
  EXPECT_NE(message.find("element type number of CGNS 3.0"), std::string::npos) << message;
  EXPECT_NE(message.find("`cgnsupdate IN OUT`"), std::string::npos) << message;
}

TEST(Cgns, RefusesPolyhedraThatAreNotThoseOfTheirFile) {
  for (const Shape shape : {Shape::polygon, Shape::polyhedron}) {
    Mesh mesh = test::cells_of_type(shape, 7, 2);
    auto metadata = std::make_shared<cgns::CgnsMetadata>();
    metadata->cell_of_polygon = {0};
    metadata->cell_of_polyhedron = {0};
    mesh.format_metadata = std::move(metadata);
    const TemporaryFolder folder;
    const std::string message = test::refusal([&] { write_mesh(mesh, folder.path() / "a.cgns"); });
    EXPECT_NE(message.find("of the file that it was read from"), std::string::npos) << message;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.cgns"));
  }
}

TEST(Cgns, RefusesNodesOfAdfThatPointElsewhere) {
  const std::string file = adf_file();
  const TemporaryFolder folder;
  for (const auto& [what, at, fresh, expected] :
       std::vector<std::tuple<std::string, std::size_t, std::string, std::string>>{
           {"the root", 0x86, "7FFFFFFF", "lies beyond the end of the file"},
           {"a tag", file.find("TaiL"), "Tail", "'TaiL' is missing"},
           {"a pointer", file.find("SNTb") + 4, "0000000G", "is not hexadecimal"},
           {"the end of children", file.find("SNTb") + 4, "00000001",
            "the table of children has a wrong end"},
           {"the end of values", file.find("DaTa") + 4, "000000000000", "values end before they begin"}}) {
    std::string broken = file;
    broken.replace(at, fresh.size(), fresh);
    const std::string message = test::read_error(folder.file("b.cgns", broken));
    EXPECT_NE(message.find(expected), std::string::npos) << what << ": " << message;
  }
}

TEST(Cgns, RefusesAnAdfFileInWhichANodeIsItsOwnChild) {
  std::string file = adf_file();
  // the first child of the root is the root: block 0, byte 266
  file.replace(file.find("SNTb") + 48, 12, "00000000010A");
  const TemporaryFolder folder;
  const std::string message = test::read_error(folder.file("a.cgns", file));
  EXPECT_NE(message.find("a node has two parents"), std::string::npos) << message;
}

TEST(Cgns, ReadsOrRefusesDamagedFilesOfAdf) {
  const std::string text = adf_file();
  const std::string binary = with_binary_pointers(text);
  const TemporaryFolder folder;
  std::mt19937 random(3);
  for (int k = 0; k < 600; ++k) {
    const std::string& file = k % 2 == 0 ? text : binary;
    std::string broken = k % 16 < 2 ? file.substr(0, random() % file.size()) : file;
    for (std::size_t changes = random() % 4; changes > 0; --changes) {
      if (!broken.empty()) broken[random() % broken.size()] = static_cast<char>(random() % 256);
    }
    try {
      (void)read_mesh(folder.file("a.cgns", broken));
    } catch (const InputError&) {  // is allowed, too
    }
  }
}

}  // namespace
}  // namespace meshorder
