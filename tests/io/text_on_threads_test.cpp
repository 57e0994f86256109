// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Texts of several megabytes, which several threads read in parts.
#include "support/files.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;

constexpr int kItems = 200000;  // points and cells of a mesh; about five parts

/// What a reader makes of a file: a mesh or an error, and its notes.
struct Outcome {
  Mesh mesh = {};
  std::string fault = {};
  Notes notes = {};

  bool operator==(const Outcome& other) const {
    return mesh.points == other.mesh.points && mesh.cells == other.mesh.cells &&
           mesh.vertex_ids == other.mesh.vertex_ids && mesh.cell_ids == other.mesh.cell_ids &&
           std::ranges::equal(mesh.data, other.mesh.data,
                              [](const DataArray& a, const DataArray& b) {
                                return a.name == b.name && a.values == b.values;
                              }) &&
           fault == other.fault && notes == other.notes;
  }
};

Outcome read_on(int threads, const std::filesystem::path& path) {
  Outcome outcome;
  try {
    outcome.mesh = read_mesh(path, {.notes = &outcome.notes, .run = {.threads = threads}});
  } catch (const InputError& error) {
    outcome.fault = error.what();
  }
  return outcome;
}

/// EXPECTs that a text is read, and that the text and variants of it are read alike on any number of threads.
/// In the variants, a line in one of several parts is replaced.
///
/// @return the mesh of the text
Mesh expect_alike(const std::string& name, const std::string& text) {
  const std::vector<std::string> others = {
      "",      "\n",         "x",      "% none\n", "# none\n", "1 2 3 4 5 6 7 8 9 10\n",
      "1 1\n", "-1 -2 -3\n", "1\r2\r", "1 tet\n"};
  const TemporaryFolder folder;
  const Outcome whole = read_on(1, folder.file(name, text));
  EXPECT_EQ(whole.fault, "");
  EXPECT_TRUE(read_on(2, folder.path() / name) == whole);
  const std::string padded = folder.file(name, text + std::string("\n\0\0", 3));
  for (const int threads : {1, 2, 7})
    EXPECT_TRUE(read_on(threads, padded) == whole) << name << ", zero bytes";
  for (std::size_t k = 0; k < others.size(); ++k) {
    const std::size_t at = text.find('\n', text.size() / others.size() * k + 100) + 1;
    const std::string file =
        folder.file(name, text.substr(0, at) + others[k] +
                              (k % 2 == 0 ? text.substr(at) : text.substr(text.find('\n', at) + 1)));
    const Outcome expected = read_on(1, file);
    for (const int threads : {2, 7}) EXPECT_TRUE(read_on(threads, file) == expected) << name << others[k];
  }
  return whole.mesh;
}

std::string words(const std::vector<int>& numbers) { return fmt::format("{}", fmt::join(numbers, " ")); }

TEST(TextOnThreads, MatrixMarketIsReadAsOnOne) {
  std::string text = "%%MatrixMarket matrix coordinate real general\n";
  text += words({kItems, kItems, 2 * kItems - 1}) + "\n";
  for (int k = 1; k <= kItems; ++k) {
    text += fmt::format("{} {} 1.5\n", k, k);
    if (k > 1) text += fmt::format("{} {} -0.25\n", k - 1, k);
  }
  const Mesh mesh = expect_alike("m.mtx", text);
  ASSERT_EQ(mesh.cell_count(), 2 * kItems - 1);
  EXPECT_THAT(mesh.cells[2 * kItems - 3], testing::ElementsAre(kItems - 1));
  EXPECT_THAT(mesh.cells[2 * kItems - 2], testing::ElementsAre(kItems - 2, kItems - 1));
}

TEST(TextOnThreads, GraphsOfMetisAreReadAsOnOne) {
  // a path whose first and middle vertices are isolated: their lines are empty
  std::string text = words({kItems + 2, kItems - 2, 1}) + "\n\n";
  const int middle = kItems / 2;
  for (int k = 2; k <= kItems + 2; ++k) {
    const int v = k <= middle ? k : k - 1;  // place on the path
    const auto at = [&](int place) { return place <= middle ? place : place + 1; };
    std::vector<int> line;
    if (k != middle + 1) {
      if (v > 2 && v != middle + 1) line.insert(line.end(), {at(v - 1), 7});
      if (v != middle && v < kItems + 1) line.insert(line.end(), {at(v + 1), 7});
    }
    text += words(line) + "\n";
  }
  const Mesh mesh = expect_alike("m.graph", text);
  ASSERT_EQ(mesh.cell_count(), kItems - 2);
  EXPECT_THAT(mesh.cells[kItems - 3], testing::ElementsAre(kItems, kItems + 1));
}

TEST(TextOnThreads, Su2IsReadAsOnOne) {
  std::string text = fmt::format("NDIME= 2\nNELEM= {}\n", kItems);
  for (int k = 0; k < kItems; ++k) {
    text +=
        fmt::format("{}\n", k % 5 == 1 ? words({5, k, k + 1, k + 2}) : words({9, k, k + 1, k + 2, k + 3}));
  }
  text += fmt::format("NPOIN= {}\n", kItems + 3);
  for (int k = 0; k < kItems + 3; ++k) text += fmt::format("{} {}.5 {}\n", k % 100, k % 7, k);
  const Mesh mesh = expect_alike("m.su2", text);
  ASSERT_EQ(mesh.cell_count(), kItems);
  EXPECT_THAT(mesh.cells[kItems - 4], testing::ElementsAre(kItems - 4, kItems - 3, kItems - 2));
  EXPECT_EQ(mesh.points.back(), (Point{(kItems + 2) % 100, (kItems + 2) % 7 + 0.5, 0}));
}

TEST(TextOnThreads, ANodeWithoutAPointIsFoundOnItsLine) {
  const TemporaryFolder folder;
  const std::string text =
      "NDIME= 2\n% none\nNELEM= 3\n5 0 1 2\n\n5 0 1 9\n% none\n5 0 1 9\nNPOIN= 3\n0 0\n1 0\n0 1\nNMARK= 0\n";
  for (const int threads : {1, 2, 7}) {
    const std::string fault = read_on(threads, folder.file("m.su2", text)).fault;
    EXPECT_THAT(fault, testing::HasSubstr("m.su2:6: a node of the element is 9")) << threads;
  }
}

TEST(TextOnThreads, UcdIsReadAsOnOne) {
  std::string text = words({kItems, kItems - 4, 1, 0, 0}) + "\n";
  for (int k = 0; k < kItems; ++k) text += fmt::format("{} {} {} 0.5\n", k + 1, k % 100, k % 7);
  for (int k = 1; k <= kItems - 4; ++k) {
    text += k % 5 == 2 ? fmt::format("{} {} tri {}\n", k, k % 3, words({k, k + 1, k + 2}))
                       : fmt::format("{} {} quad {}\n", k, k % 3, words({k, k + 1, k + 2, k + 3}));
  }
  text += "1 1\nheat, K\n";
  for (int k = 1; k <= kItems; ++k) text += fmt::format("{} {}.25\n", k, k);
  const Mesh mesh = expect_alike("m.ucd", text);
  ASSERT_EQ(mesh.cell_count(), kItems - 4);
  EXPECT_THAT(mesh.cells[1], testing::ElementsAre(1, 2, 3));
  EXPECT_THAT(mesh.cells[kItems - 5], testing::ElementsAre(kItems - 5, kItems - 4, kItems - 3, kItems - 2));
  EXPECT_EQ(std::get<std::vector<double>>(mesh.data.back().values).back(), kItems + 0.25);
}

}  // namespace
}  // namespace meshorder
