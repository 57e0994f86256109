// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The text of surfaces is parsed on all threads, in parts of 64 KiB and more. Lines that end in a carriage
// return alone are read one by one: what comes of them is expected of the same text with line feeds.
#include "support/files.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace meshorder {
namespace {

using test::TemporaryFolder;

constexpr int kLatticeRows = 80;

/// Reads the text as a file of that name. Returns the file that is then written, or the message of the error.
std::string written_again(const TemporaryFolder& folder, const std::string& name, std::string_view text,
                          int threads) {
  const std::filesystem::path again = folder.path() / ("again-" + name);
  try {
    write_mesh(read_mesh(folder.file(name, text), {.run = {.threads = threads}}), again);
  } catch (const Error& error) {
    return error.what();
  }
  return test::content_of(again);
}

void expect_same_on_threads(const std::string& name, const std::string& text, std::string_view what) {
  const TemporaryFolder folder;
  std::string by_lines = text;
  std::replace(by_lines.begin(), by_lines.end(), '\n', '\r');
  const std::string expected = written_again(folder, name, by_lines, 1);
  for (const int threads : {1, 2, 7})
    EXPECT_TRUE(written_again(folder, name, text, threads) == expected) << what << ", threads: " << threads;
}

/// Inserts each line at several places of the text, each behind `before`, also where parts of the text meet.
void expect_same_with_any_of(const std::string& name, const std::string& text,
                             std::initializer_list<std::string_view> lines, std::string_view before = "\n") {
  ASSERT_GT(text.size(), std::size_t{3} << 16);
  expect_same_on_threads(name, text, "the whole");
  for (const std::string_view line : lines) {
    for (const std::size_t from : {text.size() / 2, (std::size_t{1} << 17) - 1, text.size() - 200}) {
      const std::size_t at = text.find(before, from) + before.size();
      expect_same_on_threads(name, std::string(text).insert(at, line),
                             fmt::format("{} at byte {}", line, at));
    }
  }
}

std::array<double, 3> lattice_point(int i, int j) { return {i + 0.001 * j, j * 1.1, 0.0625 * ((i * j) % 7)}; }

/// A lattice of triangles and quads with colours, texture coordinates, normals, groups and materials.
std::string obj_text() {
  std::string text = "# a lattice\nmtllib a.mtl\n";
  for (int i = 0; i < kLatticeRows; ++i) {
    for (int j = 0; j < kLatticeRows; ++j) {
      const auto [x, y, z] = lattice_point(i, j);
      text += fmt::format("v {} {} {}{}\n", x, y, z, i == 5 ? " 0.5 0.25 1" : i == 6 ? " 2" : "");
      text += fmt::format("vt {} {}\nvn 0 {} 1\n", x / kLatticeRows, y / kLatticeRows, z);
    }
  }
  for (int i = 0; i + 1 < kLatticeRows; ++i) {
    text += fmt::format("g row{}\nusemtl m{}\n", i / 9, i / 20);
    for (int j = 0; j + 1 < kLatticeRows; ++j) {
      const int a = i * kLatticeRows + j + 1;
      const int b = a + kLatticeRows;
      if (j % 3 == 0) {
        text += fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2} {3}/{3}/{3}\n", a, b, b + 1, a + 1);
      } else if (j % 3 == 1) {
        text += fmt::format("f {}//{} {}//{} {}//{}\n", a, b, b, a, a + 1, 1);
      } else {
        text += fmt::format("f {}/1 {}/2 {}/3\nf {} {} {}\n", a, b, b + 1, a, b + 1, a + 1);
      }
    }
  }
  return text;
}

TEST(SurfacesOnThreads, ReadObjLineByLineWhereItIsNotPlain) {
  expect_same_with_any_of("a.obj", obj_text(),
                          {"# a comment\n",   "\n \n",         "f -1 -2 -3\n",  "f 1 2 3 \\\n4\n",
                           "f 1 2\\\n 3 4\n", "v 1 2 3 # c\n", "v 1 2\n",       "v 1 2 3 4 5\n",
                           "v nan 0 0\n",     "v 1 2 +3\n",    "vt 1 2 3 4\n",  "vn 0 1\n",
                           "f 1 2\n",         "f 1/ 2/ 3/\n",  "f 1/1 2 3\n",   "f 1/1/1 2//1 3/1/1\n",
                           "f 0 1 2\n",       "f 1 2 6401\n",  "f 1 2 99999\n", "f 1/99999 2/1 3/1\n",
                           "f 1 2 3 4 5\n",   "l 1 2\n",       "usemtl\n",      "g a b\n",
                           "s 3\n",           "curv 1\n",      "v 1\f2 3 4\n"});
}

std::string stl_text() {
  std::string text;
  for (int i = 0; i + 1 < kLatticeRows; ++i) {
    if (i % 30 == 0) text += fmt::format("{}solid part {}\n", i > 0 ? "endsolid\n" : "", i);
    for (int j = 0; j + 1 < kLatticeRows; j += 2) {
      text += fmt::format("facet normal 0 0 {}\n  outer loop\n", j % 3 - 1);
      for (const auto& [x, y, z] : {lattice_point(i, j), lattice_point(i + 1, j), lattice_point(i, j + 1)})
        text += fmt::format("    vertex {} {} {}\n", x, y, z);
      text += "  endloop\nendfacet\n";
    }
  }
  return text + "endsolid\n";
}

TEST(SurfacesOnThreads, ReadStlWordByWordWhereItIsNotPlain) {
  const std::string facet = "facet normal 0 0 1 outer loop vertex 9 0 0 vertex 0 9 0 vertex 0 0 9";
  expect_same_with_any_of(
      "a.stl", stl_text(),
      {"\n", "junk\n", "endfacet\n", "endloop\nendfacet\n", "vertex 1 2 3\n", "vertex 1 nan 3\n",
       "endsolid\nsolid x\n", "solid y\n", facet + " endloop endfacet\n",
       facet + " end loop end facet junk\n", facet + " endloop\nendfacet facet\n"},
      "endfacet\n");
}

/// The vertices of a lattice with more numbers in each line, and faces of three and four vertices.
std::string lattice(std::string text, std::string_view more_of_vertex, std::string_view more_of_face) {
  for (int i = 0; i < kLatticeRows; ++i) {
    for (int j = 0; j < kLatticeRows; ++j) {
      const auto [x, y, z] = lattice_point(i, j);
      text += fmt::format("{} {} {}{}\n", x, y, z, more_of_vertex);
    }
  }
  for (int i = 0; i + 1 < kLatticeRows; ++i) {
    for (int j = 0; j + 1 < kLatticeRows; ++j) {
      const int a = i * kLatticeRows + j;
      const int b = a + kLatticeRows;
      text += j % 2 == 0 ? fmt::format("4 {} {} {} {}{}\n", a, b, b + 1, a + 1, more_of_face)
                         : fmt::format("3 {} {} {}{}\n", a, b, b + 1, more_of_face);
    }
  }
  return text;
}

constexpr int kLatticeVertices = kLatticeRows * kLatticeRows;
constexpr int kLatticeFaces = (kLatticeRows - 1) * (kLatticeRows - 1);

TEST(SurfacesOnThreads, ReadOffAsOneByOne) {
  const std::string head = fmt::format("OFF\n{} {} 0\n", kLatticeVertices, kLatticeFaces);
  expect_same_with_any_of(
      "a.off", lattice(head, "", ""),
      {"# a comment\n", "\n", "1 2 3\n", "1 2\n3\n", "1 2 3 # c\n", "1 nan 3\n", "1 2 +3\n", "3 0 1 2\n",
       "3 0 1\n", "3 0 1 6400\n", "3 0 1 -1\n", "3 0 1 2 255 0 0\n", "5 0 1 2 3 4\n", "0\n", "3\n0 1\n2\n"});
  expect_same_on_threads("a.off", lattice(head, " 255 0 1", " 1"), "colours");
}

TEST(SurfacesOnThreads, ReadPlyAsOneByOne) {
  const std::string head = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty float y\nproperty double z\n"
      "property uchar red\nproperty float q\nelement face {}\nproperty list uchar int vertex_indices\n"
      "property short k\nend_header\n",
      kLatticeVertices, kLatticeFaces);
  expect_same_with_any_of(
      "a.ply", lattice(head, " 7 0.1", " -5"),
      {"\n", "1 2 3 4 5\n", "1 2 3\n4 5\n", "1 2 3 256 5\n", "1 2 3 -1 5\n", "1 nan 3 4 5\n", "1 2 3 4 nan\n",
       "1 2 +3 4 5\n", "3 0 1 2 -5\n", "3 0 1 2 40000\n", "3 0 1 6400 1\n", "3 0 1 -1 1\n", "5 0 1 2 3 4 1\n",
       "0 1\n", "3\n0 1\n2 1\n", "300 1\n"});
  std::string bytes =
      "ply\nformat ascii 1.0\nelement vertex 300\nproperty short x\nproperty int y\nproperty int z\n"
      "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  for (int v = 0; v < 300; ++v) bytes += "1 2 3\n";
  for (const std::string_view face : {"3 0 1 255\n", "3 0 1 256\n"})
    expect_same_on_threads("b.ply", bytes + std::string(face), face);
  expect_same_on_threads("b.ply", test::with(bytes, "1 2 3", "32768 2 3") + "3 0 1 2\n", "a wide coordinate");
}

}  // namespace
}  // namespace meshorder
